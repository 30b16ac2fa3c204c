// SPDX-License-Identifier: MIT
import { Color } from 'three';
import type { RadiancePicture } from '../environment';
import type { KilnLight } from '../light';
import { directionOf } from '../harmonics';
import type { State } from './state';

type Rgb = [number, number, number];

/** Makes a small equirectangular picture from a function of the direction. */
function painted(radiance: (x: number, y: number, z: number) => Rgb): RadiancePicture {
  const [width, height] = [128, 64];
  const data = new Float32Array(3 * width * height);
  for (let j = 0; j < height; ++j)
    for (let i = 0; i < width; ++i) {
      const azimuth = 2 * Math.PI * ((i + 0.5) / width - 0.5);
      const elevation = Math.PI * ((j + 0.5) / height - 0.5);
      data.set(radiance(Math.cos(elevation) * Math.cos(azimuth), Math.sin(elevation), Math.cos(elevation) * Math.sin(azimuth)), 3 * (j * width + i));
    }
  return { width, height, stride: 3, data, decode: (value) => value, topFirst: false };
}

/** Returns 1 inside of a cone around a direction, 0 outside, with a soft edge. */
function lamp(azimuth: number, elevation: number, degrees: number, x: number, y: number, z: number): number {
  const d = directionOf(azimuth, elevation);
  const cosine = x * d[0] + y * d[1] + z * d[2];
  const [edge, inner] = [Math.cos(((degrees + 6) * Math.PI) / 180), Math.cos(((degrees - 6) * Math.PI) / 180)];
  const t = Math.min(1, Math.max(0, (cosine - edge) / (inner - edge)));
  return t * t * (3 - 2 * t);
}

function mix(a: Rgb, b: Rgb, t: number): Rgb {
  return [a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t, a[2] + (b[2] - a[2]) * t];
}

function added(a: Rgb, b: Rgb, factor: number): Rgb {
  return [a[0] + b[0] * factor, a[1] + b[1] * factor, a[2] + b[2] * factor];
}

/** Skies that need no file. */
const skies = {
  overcast: painted((_x, y) => (y > 0 ? mix([0.75, 0.8, 0.85], [1.15, 1.2, 1.3], y) : mix([0.3, 0.28, 0.25], [0.12, 0.11, 0.1], -y))),
  sunset: painted((x, y, z) => {
    const sky = y > 0 ? mix([0.95, 0.5, 0.28], [0.12, 0.2, 0.42], Math.sqrt(y)) : ([0.1, 0.075, 0.06] as Rgb);
    return added(added(sky, [1.2, 0.45, 0.15], 0.6 * lamp(70, 6, 34, x, y, z)), [24, 10, 3.6], lamp(70, 10, 9, x, y, z));
  }),
  studio: painted((x, y, z) => {
    const room: Rgb = y > -0.2 ? [0.08, 0.08, 0.085] : [0.05, 0.05, 0.05];
    const key = added(room, [9, 8.7, 8.2], lamp(50, 40, 18, x, y, z));
    return added(added(key, [1.6, 1.9, 2.4], lamp(-70, 15, 24, x, y, z)), [3.4, 3.3, 3.2], lamp(190, 45, 14, x, y, z));
  }),
};

/** Gives an asset the light that was chosen; `file` is the picture of a file. */
export function applyLight(light: KilnLight, state: State, file: RadiancePicture | null): void {
  const color = new Color(state.color).multiplyScalar(state.strength);
  light.clear();
  if (state.light === 'sun') light.addDirectional(state.azimuth, state.elevation, color);
  if (state.light === 'soft') light.addCone(state.azimuth, state.elevation, state.softness, color);
  if (state.light === 'sky') light.addHemisphere(color, color.clone().multiplyScalar(0.1), state.azimuth, state.elevation);
  if (state.light === 'even') light.addAmbient(color);
  if (state.fill > 0 && (state.light === 'sun' || state.light === 'soft')) light.addAmbient(state.fill);
  const picture = state.environment === 'none' ? null : state.environment === 'file' ? file : skies[state.environment];
  if (picture) light.setEnvironment(picture, state.environmentTurn, state.environmentStrength);
  light.window = state.window;
  light.bands = state.bands;
}
