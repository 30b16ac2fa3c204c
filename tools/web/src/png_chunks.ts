// SPDX-License-Identifier: MIT
// The outside of a PNG: browsers draw what they can of a damaged one, which must not pass for data.

export interface PngHeader {
  width: number;
  height: number;
  bits: number;
  /** 0: grey. */
  colorType: number;
  interlaced: boolean;
}

const crcTable = Uint32Array.from({ length: 256 }, (_, n) => {
  let c = n;
  for (let k = 0; k < 8; ++k) c = c & 1 ? 0xedb88320 ^ (c >>> 1) : c >>> 1;
  return c;
});

function crc(bytes: Uint8Array, begin: number, end: number): number {
  let c = 0xffffffff;
  for (let i = begin; i < end; ++i) c = crcTable[(c ^ bytes[i]) & 255] ^ (c >>> 8);
  return (c ^ 0xffffffff) >>> 0;
}

/** Returns what a PNG's header says, after every chunk's checksum was found right; else a text of what is wrong. */
export function readPngHeader(bytes: Uint8Array): PngHeader | string {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  if (bytes.length < 57 || view.getUint32(0) !== 0x89504e47 || view.getUint32(4) !== 0x0d0a1a0a) return 'its first bytes are no PNG\'s';
  let ended = false;
  for (let at = 8; !ended; ) {
    if (at + 12 > bytes.length) return 'it ends early';
    const length = view.getUint32(at);
    if (at + 12 + length > bytes.length) return 'it ends early';
    if (crc(bytes, at + 4, at + 8 + length) !== view.getUint32(at + 8 + length)) return `the checksum at byte ${at + 8 + length} is wrong`;
    ended = view.getUint32(at + 4) === 0x49454e44;
    at += 12 + length;
  }
  if (view.getUint32(12) !== 0x49484452) return 'it begins without a header';
  return { width: view.getUint32(16), height: view.getUint32(20), bits: bytes[24], colorType: bytes[25], interlaced: bytes[28] !== 0 };
}
