// SPDX-License-Identifier: MIT
// Decodes PNGs of numbers. Pictures of 8 bits are the browser's work, and those of 16, which browsers cut to 8, fast-png's.
import { decode, encode } from 'fast-png';
import { readPngHeader } from './png_chunks';
import type { PngAnswer, PngJob, PngWish } from './png_jobs';

class Fault {
  constructor(readonly file: string, readonly found: string, readonly expected: string, readonly remedy = 'Copy the folder anew, or run `kiln check` on it.') {}
}

let canvas: OffscreenCanvasRenderingContext2D | null = null;

/** Decodes a sound grey PNG of 8 bits by the browser. */
async function browserDecode(bytes: Uint8Array, width: number, height: number): Promise<Uint8Array> {
  const bitmap = await createImageBitmap(new Blob([bytes as Uint8Array<ArrayBuffer>], { type: 'image/png' }), { colorSpaceConversion: 'none', premultiplyAlpha: 'none' });
  if (!canvas || canvas.canvas.width !== width || canvas.canvas.height !== height)
    canvas = new OffscreenCanvas(width, height).getContext('2d', { willReadFrequently: true, alpha: false })!;
  const context = canvas;
  context.drawImage(bitmap, 0, 0);
  bitmap.close();
  const { data } = context.getImageData(0, 0, width, height);
  const values = new Uint8Array(width * height);
  for (let i = 0; i < values.length; ++i) values[i] = data[4 * i];
  return values;
}

/** Tells whether the browser gives back what a picture holds: some alter pixels of a canvas against tracking. */
async function isBrowserExact(): Promise<boolean> {
  const side = 64;
  const data = Uint8Array.from({ length: side * side }, (_, i) => (i * 167 + (i >> 6) * 29) & 255);
  try {
    const back = await browserDecode(encode({ width: side, height: side, channels: 1, depth: 8, data }), side, side);
    return back.every((value, i) => value === data[i]);
  } catch {
    return false;
  }
}

let browserExact: Promise<boolean> | undefined;

/** Returns the stored values, row 0 at the top. */
async function numbersOf(wish: PngWish): Promise<Uint8Array | Uint16Array> {
  const header = readPngHeader(wish.bytes);
  if (typeof header === 'string') throw new Fault(wish.file, `no sound PNG: ${header}`, 'a PNG');
  if (header.width !== wish.width || header.height !== wish.height)
    throw new Fault(wish.file, `${header.width} x ${header.height} texels`, `${wish.width} x ${wish.height}`);
  if (header.colorType !== 0) throw new Fault(wish.file, header.colorType === 3 ? 'a palette' : 'colours or alpha', 'a grey picture');
  if (header.bits !== wish.bits) throw new Fault(wish.file, `${header.bits} bits`, `${wish.bits} bits`);
  try {
    if (wish.bits === 8 && (await (browserExact ??= isBrowserExact()))) return await browserDecode(wish.bytes, wish.width, wish.height);
    return decode(wish.bytes).data as Uint8Array | Uint16Array;
  } catch (error) {
    throw new Fault(wish.file, `no sound PNG (${error instanceof Error ? error.message : String(error)})`, 'a PNG');
  }
}

function flipped<T extends Uint8Array | Uint16Array>(values: T, width: number, height: number): T {
  const turned = values.slice() as T;
  for (let row = 0; row < height; ++row) turned.set(values.subarray(row * width, (row + 1) * width), (height - 1 - row) * width);
  return turned;
}

/** Returns the largest of some numbers, at least 1. */
function largestOf(values: ArrayLike<number>): number {
  let largest = 1;
  for (let i = 0; i < values.length; ++i) if (values[i] > largest) largest = values[i];
  return largest;
}

async function answer(job: PngJob): Promise<PngAnswer> {
  if (job.kind === 'numbers') {
    const wish = job.pictures[0];
    return { id: job.id, numbers: flipped(await numbersOf(wish), wish.width, wish.height) };
  }
  const { width, height } = job.pictures[0];
  const size = 4 * width * height;
  const layers = job.form === 'floats' ? [new Float32Array(size)] : job.form === 'bytes' ? [new Uint8Array(size)] : [new Uint8Array(size), new Uint8Array(size)];
  // The browser decodes them side by side.
  const stored = await Promise.all(job.pictures.map(numbersOf));
  const factors = stored.map((values) => (job.spread && job.form === 'bytes' ? Math.floor(255 / largestOf(values)) : 1));
  for (const [channel, wish] of job.pictures.entries()) {
    const values = stored[channel];
    // Weights of a compressed asset may differ in their bits: those of 8 are written as what they are of 16.
    const widen = wish.bits === 8 && job.form === 'byte-pairs' ? 257 : factors[channel];
    const unit = job.form === 'floats' ? 1 / (2 ** wish.bits - 1) : 1;
    for (let row = 0; row < height; ++row) {
      let to = 4 * (height - 1 - row) * width + channel;
      for (let at = row * width; at < (row + 1) * width; ++at, to += 4) {
        const value = values[at] * widen;
        if (layers.length === 1) layers[0][to] = value * unit;
        else {
          layers[0][to] = value >> 8;
          layers[1][to] = value & 255;
        }
      }
    }
  }
  return { id: job.id, layers, factors };
}

// One job after the other, so that the first is done first.
let queue = Promise.resolve();
self.onmessage = (event: MessageEvent<PngJob>) => {
  queue = queue.then(() => work(event.data));
};

async function work(job: PngJob): Promise<void> {
  let reply: PngAnswer;
  try {
    reply = await answer(job);
  } catch (error) {
    reply = { id: job.id, fault: error instanceof Fault ? { ...error } : { file: job.pictures[0].file, found: `a picture that could not be decoded (${String(error)})`, expected: 'a PNG', remedy: 'Reload the page.' } };
  }
  const buffers = 'layers' in reply ? reply.layers.map((layer) => layer.buffer) : 'numbers' in reply ? [reply.numbers.buffer] : [];
  self.postMessage(reply, { transfer: buffers as ArrayBuffer[] });
}
