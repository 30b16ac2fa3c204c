// SPDX-License-Identifier: MIT

/** A picture to decode, and what it must be. */
export interface PngWish {
  file: string;
  bytes: Uint8Array;
  width: number;
  height: number;
  bits: 8 | 16;
}

/** Up to four grey pictures, to become the channels of one layer (bits 8) or of two (bits 16: high bytes, low bytes). */
export interface LayerJob {
  id: number;
  kind: 'layer';
  bits: 8 | 16;
  pictures: PngWish[];
}

/** One grey picture, whose numbers are wanted as they are, rows from the bottom. */
export interface NumbersJob {
  id: number;
  kind: 'numbers';
  pictures: [PngWish];
}

export type PngJob = LayerJob | NumbersJob;

export type PngAnswer =
  | { id: number; layers: Uint8Array[] }
  | { id: number; numbers: Uint8Array | Uint16Array }
  | { id: number; fault: { file: string; found: string; expected: string; remedy: string } };
