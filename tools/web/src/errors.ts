// SPDX-License-Identifier: MIT

/** A fault of an asset, said the way Kiln's programs say it: the file, what was found, what was expected, what to do. */
export class KilnError extends Error {
  constructor(
    readonly file: string,
    readonly found: string,
    readonly expected: string,
    readonly remedy: string,
  ) {
    super(`${file}: found ${found}; expected ${expected}. ${remedy}`);
    this.name = 'KilnError';
  }
}
