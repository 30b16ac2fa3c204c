// SPDX-License-Identifier: MIT
import { type BufferGeometry, type DataTexture, Matrix4, Mesh, type Object3D, type ShaderMaterial, Vector3 } from 'three';
import { HarmonicRotation } from './harmonics';
import { type Coefficients, KilnLight } from './light';
import type { Manifest } from './manifest';
import { makeLightTexture, makeRelitMaterial, type SurfaceTextures } from './material';
import type { AssetSource } from './sources';
import { type ClusterTables, fillLight, lightTexels, type PlanePlace } from './weights';

/** Albedo where the asset does not know it. */
const grey = [0.8, 0.8, 0.8];

/** Bytes that may go to the GPU in a frame; one layer goes in any case. */
const uploadBytes = 4 << 20;

export interface AssetParts {
  source: AssetSource;
  manifest: Manifest;
  geometry: BufferGeometry;
  textures: SurfaceTextures;
  places: PlanePlace[];
  tables: ClusterTables | null;
}

/**
 * An asset in a scene: add `mesh`, and set `light`. Both follow three.js's conventions; the mesh may be moved, turned
 * and scaled evenly.
 */
export class KilnAsset {
  readonly mesh: Mesh<BufferGeometry, ShaderMaterial>;
  readonly light = new KilnLight();
  readonly manifest: Manifest;
  readonly source: AssetSource;
  readonly textures: SurfaceTextures;
  /** Resolves when all of the asset has arrived; at once unless it was loaded progressively. */
  ready: Promise<void> = Promise.resolve();
  /** Bytes that were read. */
  bytes = 0;
  /** Called when a picture would look different now: a layer has arrived. */
  onchange: () => void = () => {};

  private readonly places: PlanePlace[];
  private readonly tables: ClusterTables | null;
  private readonly lightTexture: DataTexture;
  private readonly waiting: number[] = [];
  private key = '';
  private coefficient = -1;
  private theTint: number[] | null = null;

  constructor(parts: AssetParts) {
    this.manifest = parts.manifest;
    this.source = parts.source;
    this.textures = parts.textures;
    this.places = parts.places;
    this.tables = parts.tables;
    this.lightTexture = makeLightTexture(lightTexels(parts.manifest, parts.textures.layers));
    this.mesh = new Mesh(parts.geometry, makeRelitMaterial(parts.textures, this.lightTexture));
    this.mesh.name = parts.source.name;
    this.mesh.userData.kiln = this;
    this.mesh.onBeforeRender = (_renderer, scene) => this.update(scene);
  }

  get triangles(): number {
    return this.mesh.geometry.index!.count / 3;
  }

  /** Bytes of its textures and its mesh on the GPU. */
  get gpuBytes(): number {
    const { planes, transfer, clusters, albedo, opacity } = this.textures;
    let sum = this.lightTexture.image.data!.byteLength;
    for (const texture of [planes, transfer, clusters]) sum += texture?.image.data?.byteLength ?? 0;
    for (const texture of [albedo, opacity]) {
      const image = texture?.image as ImageBitmap | undefined;
      if (image) sum += 4 * image.width * image.height;
    }
    for (const attribute of Object.values(this.mesh.geometry.attributes)) sum += attribute.array.byteLength;
    return sum + this.mesh.geometry.index!.array.byteLength;
  }

  /** Texture lookups of a pixel, light and maps not counted; 0 per vertex. */
  get lookups(): number {
    if (this.manifest.vertices > 0) return 0;
    return this.textures.layers * (this.textures.exact ? 4 : 1) + (this.textures.clusters ? 4 : 0);
  }

  /** What the form is called. */
  get form(): string {
    const { vertices, clusters, channels, planes } = this.manifest;
    const what = vertices > 0 ? 'per vertex' : clusters ? `compressed, ${clusters.count} × ${clusters.components}` : `${planes.length} planes`;
    return `${what}, ${channels === 3 ? 'colour' : 'grey'} transfer, ${Math.max(...planes.map((plane) => plane.bits))} bits`;
  }

  /** Linear reflectance that is used in place of the asset's constant one, and times its map; null: the asset's own. */
  get tint(): readonly number[] | null {
    return this.theTint;
  }
  set tint(tint: readonly number[] | null) {
    this.theTint = tint ? [...tint] : null;
    this.key = '';
  }

  /** Returns the constant part of the albedo. */
  get albedo(): readonly number[] {
    const own = this.manifest.albedo;
    return this.theTint ?? (own === null ? grey : typeof own === 'string' ? [1, 1, 1] : own);
  }

  /** Shows a coefficient of transfer, blue below 0 and red above, in place of light; -1: light again. */
  showCoefficient(coefficient: number): void {
    const { material } = this.mesh;
    if (coefficient >= 0 !== 'KILN_SIGNED' in material.defines) {
      if (coefficient >= 0) material.defines.KILN_SIGNED = '';
      else delete material.defines.KILN_SIGNED;
      material.needsUpdate = true;
    }
    if (coefficient >= 0) material.uniforms.kiln_gain.value = 1 / this.largest(coefficient);
    this.coefficient = coefficient;
    this.key = '';
  }

  /** Returns about the largest magnitude of a coefficient. */
  private largest(coefficient: number): number {
    const band = Math.floor(Math.sqrt(coefficient));
    if (this.tables) return 0.4 / (band + 1);
    const ranges = this.places.filter(({ plane }) => plane.coefficient === coefficient);
    return Math.max(1e-6, ...ranges.map(({ plane }) => Math.max(Math.abs(plane.min), Math.abs(plane.max))));
  }

  /** Takes a layer that was decoded; it goes to the GPU with one of the next pictures. */
  receive(layer: number, pictures: readonly (Uint8Array | Float32Array)[]): void {
    const { planes } = this.textures;
    const size = planes!.image.width * planes!.image.height * 4;
    pictures.forEach((picture, k) => {
      (planes!.image.data as Uint8Array | Float32Array).set(picture, (layer + k) * size);
      this.waiting.push(layer + k);
    });
    this.onchange();
  }

  /** Tells whether layers wait for the next picture. */
  get isUploading(): boolean {
    return this.waiting.length > 0;
  }

  /** Lets all layers that have arrived go to the GPU with the next picture, for those who draw a single one. */
  uploadAll(): void {
    this.upload(Infinity);
  }

  private upload(most: number): void {
    const { planes } = this.textures;
    if (this.waiting.length === 0 || !planes) return;
    const size = planes.image.data!.byteLength / planes.image.depth;
    for (let sum = 0; this.waiting.length > 0 && (sum === 0 || sum + size <= most); sum += size) {
      const layer = this.waiting.shift()!;
      planes.addLayerUpdate(layer);
      for (const place of this.places)
        if (place.layer + (place.deep ? 1 : 0) === layer) place.ready = true;
    }
    planes.needsUpdate = true;
    this.key = '';
    if (this.waiting.length > 0) this.onchange();
  }

  /** Returns the light in object space. */
  objectLight(): Coefficients {
    const bands = this.manifest.bands;
    const world = this.light.coefficients(bands);
    const turn = rotationOf(this.mesh.matrixWorld);
    if (!turn) return world;
    const rotation = new HarmonicRotation(bands, turn);
    return world.map((values) => rotation.apply(values)) as Coefficients;
  }

  /** Brings the light's texture up to date. three.js calls it before the mesh is drawn. */
  update(scene: Object3D): void {
    this.upload(uploadBytes);
    this.light.observe(scene, place.setFromMatrixPosition(this.mesh.matrixWorld));
    const key = `${this.light.version} ${rotationOf(this.mesh.matrixWorld)?.join() ?? ''}`;
    if (key === this.key) return;
    this.key = key;
    const unit = () => Float64Array.from({ length: this.manifest.bands ** 2 }, (_, i) => (i === this.coefficient ? 1 : 0));
    const light: Coefficients = this.coefficient >= 0 ? [unit(), unit(), unit()] : this.objectLight();
    const albedo = this.coefficient >= 0 ? [1, 1, 1] : this.albedo;
    const values = this.lightTexture.image.data as Float32Array;
    fillLight(values, this.manifest, this.places, this.textures.layers, this.tables, light, albedo);
    this.lightTexture.needsUpdate = true;
  }

  /** Frees what the GPU holds. */
  dispose(): void {
    const { planes, transfer, clusters, albedo, opacity } = this.textures;
    for (const texture of [planes, transfer, clusters, albedo, opacity, this.lightTexture]) texture?.dispose();
    for (const texture of [albedo, opacity]) (texture?.image as ImageBitmap | undefined)?.close();
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }
}

const place = new Vector3();

/** Returns the rotation from world to object space, row by row, to about 1e-6; null where nothing turns. */
function rotationOf(world: Matrix4): number[] | null {
  const e = world.elements;
  const columns = [0, 4, 8].map((k) => {
    const length = Math.hypot(e[k], e[k + 1], e[k + 2]) || 1;
    return [e[k] / length, e[k + 1] / length, e[k + 2] / length];
  });
  const flat = columns.flat().map((v) => Math.round(v * 1e6) / 1e6);
  return flat[0] === 1 && flat[4] === 1 && flat[8] === 1 ? null : flat;
}
