// SPDX-License-Identifier: MIT
// Real, orthonormal spherical harmonics without the Condon-Shortley phase, the polar axis +Z: docs/format.md, "Basis".

/** Evaluates bands * bands harmonics at a unit vector; index l (l + 1) + m. [Holmes and Featherstone 2002] */
export function evaluateBasis(bands: number, x: number, y: number, z: number, values = new Float64Array(bands * bands)): Float64Array {
  let start = Math.sqrt(1 / (4 * Math.PI));
  let cosine = 1;
  let sine = 0;
  for (let m = 0; m < bands; ++m) {
    if (m > 0) {
      start *= Math.sqrt(((m === 1 ? 2 : 1) * (2 * m + 1)) / (2 * m));
      [cosine, sine] = [x * cosine - y * sine, x * sine + y * cosine];
    }
    let before = 0;
    let value = start;
    for (let l = m; l < bands; ++l) {
      if (l > m) {
        const a = Math.sqrt((4 * l * l - 1) / (l * l - m * m));
        const b = Math.sqrt(((l - 1) ** 2 - m * m) / (4 * (l - 1) ** 2 - 1));
        [before, value] = [value, a * (z * value - b * before)];
      }
      if (m > 0) values[l * (l + 1) - m] = value * sine;
      values[l * (l + 1) + m] = value * cosine;
    }
  }
  return values;
}

/** Returns the bands A_l of the clamped cosine. */
export function clampedCosine(bands: number): number[] {
  const values: number[] = [];
  let half = 1; // l! / (2^l ((l/2)!)^2)
  for (let l = 0; l < bands; ++l) {
    if (l === 1) values.push((2 * Math.PI) / 3);
    else if (l % 2 === 1) values.push(0);
    else {
      if (l > 0) half *= (l - 1) / l;
      values.push(l === 0 ? Math.PI : ((2 * Math.PI * (l % 4 === 2 ? 1 : -1)) / ((l + 2) * (l - 1))) * half);
    }
  }
  return values;
}

/** Returns the unit vector towards an azimuth and an elevation, in degrees: azimuth 0 is +Z, 90 is +X. */
export function directionOf(azimuth: number, elevation: number): [number, number, number] {
  const a = (azimuth * Math.PI) / 180;
  const e = (elevation * Math.PI) / 180;
  return [Math.cos(e) * Math.sin(a), Math.sin(e), Math.cos(e) * Math.cos(a)];
}

/** Rotation of functions in harmonics, a matrix for each band [Ivanic and Ruedenberg 1996, 1998]. */
export class HarmonicRotation {
  private readonly matrices: Float64Array[];

  /** `rotation` is a proper rotation, nine numbers row by row. The function f becomes f(R^-1 s). */
  constructor(
    readonly bands: number,
    rotation: ArrayLike<number>,
  ) {
    this.matrices = [new Float64Array([1])];
    if (bands === 1) return;
    // Band 1 is the rotation itself, its axes in the order y, z, x.
    const axis = [1, 2, 0];
    const first = new Float64Array(9);
    for (let i = 0; i < 3; ++i) for (let j = 0; j < 3; ++j) first[3 * i + j] = rotation[3 * axis[i] + axis[j]];
    this.matrices.push(first);
    for (let l = 2; l < bands; ++l) this.matrices.push(nextBand(first, this.matrices[l - 1], l));
  }

  apply(coefficients: ArrayLike<number>): Float64Array {
    const turned = new Float64Array(this.bands * this.bands);
    for (let l = 0; l < this.bands; ++l) {
      const side = 2 * l + 1;
      for (let i = 0; i < side; ++i)
        for (let j = 0; j < side; ++j) turned[l * l + i] += this.matrices[l][i * side + j] * coefficients[l * l + j];
    }
    return turned;
  }
}

function nextBand(first: Float64Array, before: Float64Array, l: number): Float64Array {
  const side = 2 * l + 1;
  const r = (i: number, j: number) => first[3 * (i + 1) + j + 1];
  const ofBefore = (m: number, n: number) => before[(m + l - 1) * (side - 2) + n + l - 1];
  const p = (i: number, m: number, n: number) => {
    if (n === l) return r(i, 1) * ofBefore(m, l - 1) - r(i, -1) * ofBefore(m, 1 - l);
    if (n === -l) return r(i, 1) * ofBefore(m, 1 - l) + r(i, -1) * ofBefore(m, l - 1);
    return r(i, 0) * ofBefore(m, n);
  };
  const vTerm = (m: number, n: number) => {
    if (m === 0) return p(1, 1, n) + p(-1, -1, n);
    if (m === 1) return Math.SQRT2 * p(1, 0, n);
    if (m === -1) return Math.SQRT2 * p(-1, 0, n);
    return m > 0 ? p(1, m - 1, n) - p(-1, 1 - m, n) : p(1, m + 1, n) + p(-1, -m - 1, n);
  };
  const wTerm = (m: number, n: number) => (m > 0 ? p(1, m + 1, n) + p(-1, -m - 1, n) : p(1, m - 1, n) - p(-1, 1 - m, n));
  const matrix = new Float64Array(side * side);
  for (let m = -l; m <= l; ++m)
    for (let n = -l; n <= l; ++n) {
      const denominator = Math.abs(n) === l ? 2 * l * (2 * l - 1) : (l + n) * (l - n);
      const order = Math.abs(m);
      const u = Math.sqrt(((l + m) * (l - m)) / denominator);
      const v = 0.5 * Math.sqrt(((m === 0 ? 2 : 1) * (l + order - 1) * (l + order)) / denominator);
      const w = m === 0 ? 0 : 0.5 * Math.sqrt(((l - order - 1) * (l - order)) / denominator);
      // Factors of zero stand before terms that would read outside the matrix.
      matrix[(m + l) * side + n + l] =
        (u !== 0 ? u * p(0, m, n) : 0) + (m === 0 ? -v : v) * vTerm(m, n) - (w !== 0 ? w * wTerm(m, n) : 0);
    }
  return matrix;
}
