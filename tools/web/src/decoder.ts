// SPDX-License-Identifier: MIT
import { KilnError } from './errors';
import type { LayerForm, PngAnswer, PngJob, PngWish } from './png_jobs';
import PngWorker from './png.worker?worker&inline';

interface Waiting {
  resolve: (answer: PngAnswer) => void;
  reject: (error: unknown) => void;
}

export interface DecodedLayers {
  layers: (Uint8Array | Float32Array)[];
  factors: number[];
}

/** Workers that decode pictures of numbers, at most four; they end some seconds after their last job. */
class PngDecoder {
  private workers: { worker: Worker; jobs: Map<number, Waiting> }[] = [];
  private next = 0;
  private idle: ReturnType<typeof setTimeout> | undefined;

  /**
   * Decodes up to four grey pictures into the channels of one layer, or of two for 'byte-pairs'. With `spread`, bytes are
   * multiplied by factors, one for each picture. Rejects with KilnError.
   */
  async layers(pictures: PngWish[], form: LayerForm, spread: boolean): Promise<DecodedLayers> {
    return (await this.run({ id: 0, kind: 'layer', form, spread, pictures })) as unknown as DecodedLayers;
  }

  /** Decodes a grey picture; rows from the bottom. Rejects with KilnError. */
  async numbers(picture: PngWish): Promise<Uint8Array | Uint16Array> {
    const reply = await this.run({ id: 0, kind: 'numbers', pictures: [picture] });
    return (reply as { numbers: Uint8Array | Uint16Array }).numbers;
  }

  private async run(job: PngJob): Promise<PngAnswer> {
    clearTimeout(this.idle);
    const id = ++this.next;
    const host = this.host();
    try {
      const reply = await new Promise<PngAnswer>((resolve, reject) => {
        host.jobs.set(id, { resolve, reject });
        host.worker.postMessage({ ...job, id }, job.pictures.map((picture) => picture.bytes.buffer as ArrayBuffer));
      });
      if ('fault' in reply) throw new KilnError(reply.fault.file, reply.fault.found, reply.fault.expected, reply.fault.remedy);
      return reply;
    } finally {
      host.jobs.delete(id);
      if (this.workers.every(({ jobs }) => jobs.size === 0)) this.idle = setTimeout(() => this.end(), 5000);
    }
  }

  /** Starts a worker, so that it is there when the first picture is. */
  warm(): void {
    if (this.workers.length > 0) return;
    this.add();
    this.idle = setTimeout(() => this.end(), 30_000);
  }

  private add() {
    const host = { worker: new PngWorker({ name: 'kiln-png' }), jobs: new Map<number, Waiting>() };
    host.worker.onmessage = (event: MessageEvent<PngAnswer>) => host.jobs.get(event.data.id)?.resolve(event.data);
    host.worker.onerror = (event) => {
      for (const { reject } of host.jobs.values()) reject(new Error(`kiln: the picture decoder failed: ${event.message || 'its worker could not start'}`));
    };
    this.workers.push(host);
    return host;
  }

  private host() {
    const most = Math.max(1, Math.min(4, navigator.hardwareConcurrency || 2));
    const least = this.workers.reduce((best, host) => (host.jobs.size < best ? host.jobs.size : best), Infinity);
    if (least > 0 && this.workers.length < most) return this.add();
    return this.workers.find(({ jobs }) => jobs.size === least)!;
  }

  private end(): void {
    for (const { worker } of this.workers) worker.terminate();
    this.workers = [];
  }
}

/** The decoder that all loaders share. */
export const pngDecoder = new PngDecoder();
