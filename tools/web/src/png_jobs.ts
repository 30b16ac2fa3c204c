// SPDX-License-Identifier: MIT

/** A picture to decode, and what it must be. */
export interface PngWish {
  file: string;
  bytes: Uint8Array;
  width: number;
  height: number;
  bits: 8 | 16;
}

/** How stored values stand in layers: bytes; two layers of high and of low bytes; or floats of 0 to 1. */
export type LayerForm = 'bytes' | 'byte-pairs' | 'floats';

/** Up to four grey pictures, to become the channels of a layer, or of two. */
export interface LayerJob {
  id: number;
  kind: 'layer';
  form: LayerForm;
  /** Multiply bytes by as large a factor as their largest allows: weights that use few of 256 values are then filtered finely. */
  spread: boolean;
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
  | { id: number; layers: (Uint8Array | Float32Array)[]; factors: number[] }
  | { id: number; numbers: Uint8Array | Uint16Array }
  | { id: number; fault: { file: string; found: string; expected: string; remedy: string } };
