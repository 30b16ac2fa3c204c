// SPDX-License-Identifier: MIT
// Light in spherical harmonics: docs/format.md, "Light". All of it is distant; it adds up after windowing.
import {
  type AmbientLight, type Color, type DataTexture, type DirectionalLight, type HemisphereLight, type LightProbe,
  type Object3D, type PointLight, type Scene, type SphericalHarmonics3, type Texture, Vector3,
} from 'three';
import { directionOf, evaluateBasis, HarmonicRotation } from './harmonics';
import { projectPicture, type RadiancePicture, radianceOf } from './environment';
import { axialWeights, generalWeights, type LightWindow } from './windows';

/** Linear radiance: one number for grey, three, or a three.js Color. */
export type Radiance = number | readonly [number, number, number] | Color;

/** A light with an axis, or one that is the same from everywhere. Directions are in world space. */
export type LightSpec =
  | { kind: 'directional'; direction: readonly [number, number, number]; radiance: readonly [number, number, number] }
  | { kind: 'cone'; direction: readonly [number, number, number]; halfAngle: number; radiance: readonly [number, number, number] }
  | { kind: 'hemisphere'; direction: readonly [number, number, number]; radiance: readonly [number, number, number]; ground: readonly [number, number, number] }
  | { kind: 'ambient'; radiance: readonly [number, number, number] }
  | { kind: 'harmonics'; coefficients: readonly ArrayLike<number>[]; windowed: boolean };

/** Coefficients of red, green and blue, bands * bands each. */
export type Coefficients = [Float64Array, Float64Array, Float64Array];

export function rgb(radiance: Radiance): [number, number, number] {
  if (typeof radiance === 'number') return [radiance, radiance, radiance];
  if ('isColor' in radiance) return [radiance.r, radiance.g, radiance.b];
  return [radiance[0], radiance[1], radiance[2]];
}

/** Returns z_l of a cone of half-angle `h` (radians) that gives a facing white surface radiance 1; h = 0 is a direction. */
function coneBands(bands: number, h: number): number[] {
  if (h === 0) return new Array<number>(bands).fill(Math.PI);
  const x = Math.cos(h);
  const legendre = [1, x];
  for (let l = 1; l <= bands; ++l) legendre.push(((2 * l + 1) * x * legendre[l] - l * legendre[l - 1]) / (l + 1));
  const b = h >= Math.PI / 2 ? 1 : 1 / Math.sin(h) ** 2;
  return Array.from({ length: bands }, (_, l) => (2 * Math.PI * b * ((l === 0 ? 1 : legendre[l - 1]) - legendre[l + 1])) / (2 * l + 1));
}

const axialCache = new Map<string, number[]>();

/** Returns the factors z_l w_l / f of a light around an axis. */
function windowedBands(bands: number, halfAngle: number, window: LightWindow): number[] {
  const key = `${bands} ${halfAngle} ${window}`;
  let factors = axialCache.get(key);
  if (!factors) {
    const zonal = coneBands(bands, (halfAngle * Math.PI) / 180);
    const weights = axialWeights(zonal, window);
    factors = zonal.map((z, l) => z * weights[l]);
    if (axialCache.size > 256) axialCache.clear();
    axialCache.set(key, factors);
  }
  return factors;
}

function addAxial(sum: Coefficients, bands: number, direction: readonly [number, number, number], factors: number[], radiance: readonly number[]): void {
  const basis = evaluateBasis(bands, direction[0], direction[1], direction[2]);
  for (let l = 0, i = 0; l < bands; ++l)
    for (; i < (l + 1) ** 2; ++i) for (let c = 0; c < 3; ++c) sum[c][i] += radiance[c] * factors[l] * basis[i];
}

/** Adds a light whose radiance is linear in the cosine to an axis: `mean`, and `slope` at the axis. */
function addLinear(sum: Coefficients, bands: number, d: readonly [number, number, number], mean: number[], slope: number[]): void {
  for (let c = 0; c < 3; ++c) {
    sum[c][0] += mean[c] * Math.sqrt(4 * Math.PI);
    if (bands > 1) [d[1], d[2], d[0]].forEach((x, k) => (sum[c][1 + k] += slope[c] * Math.sqrt((4 * Math.PI) / 3) * x));
  }
}

/** Adds one light. */
export function addLight(sum: Coefficients, bands: number, spec: LightSpec, window: LightWindow): void {
  switch (spec.kind) {
    case 'directional':
      return addAxial(sum, bands, spec.direction, windowedBands(bands, 0, window), spec.radiance);
    case 'cone':
      return addAxial(sum, bands, spec.direction, windowedBands(bands, spec.halfAngle, window), spec.radiance);
    case 'hemisphere': {
      const mean = spec.radiance.map((sky, c) => (sky + spec.ground[c]) / 2);
      return addLinear(sum, bands, spec.direction, mean, spec.radiance.map((sky, c) => sky - mean[c]));
    }
    case 'ambient':
      return addLinear(sum, bands, [0, 1, 0], [...spec.radiance], [0, 0, 0]);
    case 'harmonics': {
      const cut = spec.coefficients.map((values) => Float64Array.from({ length: bands * bands }, (_, i) => values[i] ?? 0));
      const weights = spec.windowed ? generalWeights(cut, bands, window) : new Array<number>(bands).fill(1);
      for (let c = 0; c < 3; ++c)
        for (let l = 0, i = 0; l < bands; ++l) for (; i < (l + 1) ** 2; ++i) sum[c][i] += weights[l] * cut[c][i];
    }
  }
}

export function noLight(bands: number): Coefficients {
  const size = bands * bands;
  return [new Float64Array(size), new Float64Array(size), new Float64Array(size)];
}

/**
 * The light that an asset receives. Without any call it is that of the scene's own three.js lights, in their units;
 * after the first call it is what was set. Angles are degrees: azimuth 0 is +Z, 90 is +X; elevation 90 is +Y. A white
 * surface that faces a directional light has the radiance given.
 */
export class KilnLight {
  private specs: LightSpec[] = [];
  private picture: RadiancePicture | null = null;
  private turn = 0;
  private strength = 1;
  private projected: { bands: number; picture: RadiancePicture; coefficients: Coefficients } | null = null;
  private scene: { key: string; specs: LightSpec[]; picture: RadiancePicture | null; turn: number; strength: number } | null = null;
  private own = false;
  private theWindow: LightWindow = 'hann';
  private most = 0;
  /** Rises with every change. */
  version = 0;

  /** Weights of the bands against ringing. */
  get window(): LightWindow {
    return this.theWindow;
  }
  set window(window: LightWindow) {
    this.theWindow = window;
    ++this.version;
  }

  /** The most bands of light to use; 0: as many as the asset has. */
  get bands(): number {
    return this.most;
  }
  set bands(bands: number) {
    this.most = bands;
    ++this.version;
  }

  /** Takes all light away. */
  clear(): this {
    this.specs = [];
    this.picture = null;
    return this.changed();
  }

  /** Lights by one distant light, in place of all others. */
  setDirectional(azimuth: number, elevation: number, radiance: Radiance = 1): this {
    return this.clear().addDirectional(azimuth, elevation, radiance);
  }

  addDirectional(azimuth: number, elevation: number, radiance: Radiance = 1): this {
    return this.add({ kind: 'directional', direction: directionOf(azimuth, elevation), radiance: rgb(radiance) });
  }

  /** Adds a soft light: a cone of directions of that half-angle. */
  addCone(azimuth: number, elevation: number, halfAngle: number, radiance: Radiance = 1): this {
    return this.add({ kind: 'cone', direction: directionOf(azimuth, elevation), halfAngle, radiance: rgb(radiance) });
  }

  /** Adds light that goes over from `sky` above to `ground` below. */
  addHemisphere(sky: Radiance, ground: Radiance, azimuth = 0, elevation = 90): this {
    return this.add({ kind: 'hemisphere', direction: directionOf(azimuth, elevation), radiance: rgb(sky), ground: rgb(ground) });
  }

  /** Adds the same radiance from everywhere. */
  addAmbient(radiance: Radiance): this {
    return this.add({ kind: 'ambient', radiance: rgb(radiance) });
  }

  /** Adds a light probe: radiance in three.js's basis, which is the first nine coefficients of ours. */
  addProbe(probe: LightProbe | SphericalHarmonics3, intensity?: number): this {
    const isLight = 'isLightProbe' in probe;
    return this.add(probeSpec(isLight ? probe.sh : probe, intensity ?? (isLight ? probe.intensity : 1)));
  }

  /** Adds coefficients of red, green and blue, of any number of bands, as they are. */
  addCoefficients(coefficients: readonly [ArrayLike<number>, ArrayLike<number>, ArrayLike<number>], windowed = false): this {
    return this.add({ kind: 'harmonics', coefficients, windowed });
  }

  add(spec: LightSpec): this {
    this.specs.push(spec);
    return this.changed();
  }

  /** Sets the environment: an equirectangular picture (a texture of HDRLoader or EXRLoader), turned about +Y; null: none. */
  setEnvironment(picture: Texture | RadiancePicture | null, turnDegrees = 0, intensity = 1): this {
    this.picture = picture === null ? null : 'isTexture' in picture ? radianceOf(picture as DataTexture) : picture;
    this.turn = turnDegrees;
    this.strength = intensity;
    return this.changed();
  }

  /** Takes the lights of a scene again, as before anything was set. */
  useScene(): this {
    this.clear();
    this.own = false;
    return this;
  }

  private changed(): this {
    this.own = true;
    ++this.version;
    return this;
  }

  /** Looks at a scene's lights, if those count. `place` is where the asset stands. */
  observe(scene: Object3D, place: Vector3): void {
    if (this.own) return;
    const specs = sceneLights(scene, place);
    const environment = (scene as Scene).environment ?? null;
    const picture = environment ? radianceOf(environment as DataTexture) : null;
    const turn = environment ? ((scene as Scene).environmentRotation.y * 180) / Math.PI : 0;
    const strength = (scene as Scene).environmentIntensity ?? 1;
    const key = JSON.stringify([specs, environment?.uuid, environment?.version, turn, strength], (_, value) =>
      ArrayBuffer.isView(value) ? Array.from(value as unknown as ArrayLike<number>) : (value as unknown));
    if (this.scene?.key === key) return;
    this.scene = { key, specs, picture, turn, strength };
    ++this.version;
  }

  /** Returns the lights that count now. */
  get lights(): readonly LightSpec[] {
    return this.own ? this.specs : (this.scene?.specs ?? []);
  }

  /** Returns the environment's coefficients, not windowed, if there is one. */
  environment(bands: number): Coefficients | null {
    const from = this.own ? { picture: this.picture, turn: this.turn, strength: this.strength } : this.scene;
    if (!from?.picture) return null;
    if (this.projected?.picture !== from.picture || this.projected.bands !== bands)
      this.projected = { bands, picture: from.picture, coefficients: projectPicture(from.picture, bands) };
    // A turn about +Y by an angle keeps all but the azimuth; as a rotation it is applied like any other.
    return turned(this.projected.coefficients, bands, from.turn, from.strength);
  }

  /** Returns the sum of all lights in world space, windowed; bands beyond `this.bands` are 0. */
  coefficients(assetBands: number): Coefficients {
    const bands = this.most > 0 ? Math.min(this.most, assetBands) : assetBands;
    const sum = noLight(bands);
    for (const spec of this.lights) addLight(sum, bands, spec, this.theWindow);
    const environment = this.environment(bands);
    if (environment) addLight(sum, bands, { kind: 'harmonics', coefficients: environment, windowed: true }, this.theWindow);
    if (bands === assetBands) return sum;
    return sum.map((values) => {
      const all = new Float64Array(assetBands * assetBands);
      all.set(values);
      return all;
    }) as Coefficients;
  }
}

function turned(coefficients: Coefficients, bands: number, degrees: number, strength: number): Coefficients {
  const [c, s] = [Math.cos((degrees * Math.PI) / 180), Math.sin((degrees * Math.PI) / 180)];
  const rotation = degrees === 0 ? null : new HarmonicRotation(bands, [c, 0, s, 0, 1, 0, -s, 0, c]);
  return coefficients.map((values) => (rotation ? rotation.apply(values) : values).map((v) => v * strength)) as Coefficients;
}

function probeSpec(sh: SphericalHarmonics3, intensity: number): LightSpec {
  const coefficients = [0, 1, 2].map((c) => sh.coefficients.map((v) => intensity * v.getComponent(c)));
  return { kind: 'harmonics', coefficients, windowed: false };
}

/**
 * Returns the lights of a scene in our units. three.js counts irradiance: a white surface that faces a light of
 * intensity I has radiance I / pi. A point light counts as a distant one, as it arrives at `place`.
 */
export function sceneLights(scene: Object3D, place: Vector3): LightSpec[] {
  const specs: LightSpec[] = [];
  const scaled = (color: Color, intensity: number) => rgb(color).map((v) => (v * intensity) / Math.PI) as [number, number, number];
  const at = new Vector3();
  const to = new Vector3();
  scene.traverseVisible((object) => {
    if ('isDirectionalLight' in object) {
      const light = object as DirectionalLight;
      at.setFromMatrixPosition(light.matrixWorld).sub(to.setFromMatrixPosition(light.target.matrixWorld)).normalize();
      specs.push({ kind: 'directional', direction: at.toArray() as [number, number, number], radiance: scaled(light.color, light.intensity) });
    } else if ('isPointLight' in object) {
      const light = object as PointLight;
      at.setFromMatrixPosition(light.matrixWorld).sub(place);
      const squared = Math.max(at.lengthSq(), 1e-12);
      specs.push({ kind: 'directional', direction: at.normalize().toArray() as [number, number, number], radiance: scaled(light.color, light.intensity / squared) });
    } else if ('isAmbientLight' in object) {
      const light = object as AmbientLight;
      specs.push({ kind: 'ambient', radiance: scaled(light.color, light.intensity) });
    } else if ('isHemisphereLight' in object) {
      // three.js lets irradiance be linear in the cosine; the radiance that gives it has 3/2 of the slope.
      const light = object as HemisphereLight;
      const [sky, ground] = [scaled(light.color, light.intensity), scaled(light.groundColor, light.intensity)];
      const end = (sign: number) => sky.map((s, c) => (s + ground[c]) / 2 + (sign * 1.5 * (s - ground[c])) / 2) as [number, number, number];
      at.setFromMatrixPosition(light.matrixWorld).normalize();
      specs.push({ kind: 'hemisphere', direction: at.toArray() as [number, number, number], radiance: end(1), ground: end(-1) });
    } else if ('isLightProbe' in object) {
      const light = object as LightProbe;
      specs.push(probeSpec(light.sh, light.intensity));
    }
  });
  return specs;
}
