// SPDX-License-Identifier: MIT
import { ClampToEdgeWrapping, DataArrayTexture, DataTexture, FloatType, LinearFilter, Loader, NearestFilter, RedIntegerFormat, UnsignedByteType } from 'three';
import { KilnAsset } from './asset';
import { pngDecoder } from './decoder';
import { warmDraco } from './draco';
import { KilnError } from './errors';
import { checkGeometry, decodeMesh, decodeVertexTransfer, vertexTransferOf } from './geometry';
import { GlbSource } from './glb';
import { type Manifest, readManifest } from './manifest';
import type { SurfaceTextures } from './material';
import { pictureTexture } from './pictures';
import type { LayerForm } from './png_jobs';
import { type AssetSource, HttpSource } from './sources';
import { type ClusterTables, clusterTables, type PlanePlace } from './weights';

/** How far a load is. */
export interface LoadProgress {
  /** Bytes that have arrived. */
  loaded: number;
  /** Files that have arrived, and how many there are. */
  files: number;
  fileCount: number;
}

/** A layer of the planes' texture, or two of byte pairs. */
interface LayerPlan {
  layer: number;
  form: LayerForm;
  places: PlanePlace[];
}

let floats: boolean | undefined;

/** Tells whether textures of floats are filtered here: not on every telephone. */
function filtersFloats(): boolean {
  if (floats === undefined) {
    const context = document.createElement('canvas').getContext('webgl2');
    floats = context?.getExtension('OES_texture_float_linear') != null;
    context?.getExtension('WEBGL_lose_context')?.loseContext();
  }
  return floats;
}

/** Puts planes into layers of four: low coefficients first, so that the first layers show the most. */
function planLayers(manifest: Manifest): LayerPlan[] {
  const order = manifest.planes.map((plane, index) => ({ plane, index }));
  if (!manifest.clusters) order.sort((a, b) => a.plane.coefficient - b.plane.coefficient || a.plane.channel - b.plane.channel);
  const plans: LayerPlan[] = [];
  const deep = manifest.planes.some((plane) => plane.bits === 16);
  const form = !deep ? 'bytes' : filtersFloats() ? 'floats' : 'byte-pairs';
  let layer = 0;
  for (let first = 0; first < order.length; first += 4) {
    const planes = order.slice(first, first + 4).map(({ plane }) => plane);
    plans.push({ layer, form, places: planes.map((plane, channel) => ({ plane, layer, channel, deep: form === 'byte-pairs', factor: 1, ready: false })) });
    layer += form === 'byte-pairs' ? 2 : 1;
  }
  return plans;
}

function planesTexture(width: number, height: number, layers: number, form: LayerForm): DataArrayTexture {
  const size = 4 * width * height * layers;
  const texture = new DataArrayTexture(form === 'floats' ? new Float32Array(size) : new Uint8Array(size), width, height, layers);
  if (form === 'floats') texture.type = FloatType;
  texture.minFilter = texture.magFilter = LinearFilter;
  texture.wrapS = texture.wrapT = ClampToEdgeWrapping;
  texture.generateMipmaps = false;
  return texture;
}

/**
 * Loads assets, as GLTFLoader loads glTF: from a folder of kiln-bake or kiln-compress (its address, or that of its
 * ranges.json or pca.json), or from a .glb of `kiln export`. Rejects with KilnError where an asset is broken.
 */
export class KilnLoader extends Loader<KilnAsset> {
  /**
   * Resolve as soon as the first layer of an uncompressed asset is there: it is shown in two bands of light, and then
   * in more as they come. `asset.ready` tells of the rest.
   */
  progressive = false;

  override load(url: string, onLoad: (asset: KilnAsset) => void, onProgress?: (event: ProgressEvent) => void, onError?: (error: unknown) => void): void {
    const address = this.manager.resolveURL(this.path + url);
    this.manager.itemStart(address);
    const report = (progress: LoadProgress) => onProgress?.(new ProgressEvent('progress', { loaded: progress.loaded }));
    this.loadSource(this.source(address), report).then(
      (asset) => {
        onLoad(asset);
        this.manager.itemEnd(address);
      },
      (error: unknown) => {
        if (onError) onError(error);
        else console.error(error);
        this.manager.itemError(address);
        this.manager.itemEnd(address);
      },
    );
  }

  private source(address: string): AssetSource {
    const credentials = this.withCredentials ? 'include' : 'same-origin';
    return /\.glb([?#]|$)/i.test(address) ? new GlbSource(address, this.requestHeader, credentials) : new HttpSource(address, this.requestHeader, credentials);
  }

  /** Loads from anything that has a manifest and bytes. */
  async loadSource(source: AssetSource, onProgress: (progress: LoadProgress) => void = () => {}): Promise<KilnAsset> {
    warmDraco();
    pngDecoder.warm();
    const { json, file } = await source.manifest();
    const manifest = readManifest(json, `${source.name}/${file}`);
    return new Load(source, manifest, onProgress).run(this.progressive && !manifest.clusters);
  }
}

/** One asset on its way. */
class Load {
  private readonly progress: LoadProgress = { loaded: 0, files: 0, fileCount: 0 };

  constructor(
    private readonly source: AssetSource,
    private readonly manifest: Manifest,
    private readonly onProgress: (progress: LoadProgress) => void,
  ) {}

  async run(progressive: boolean): Promise<KilnAsset> {
    const plans = this.manifest.vertices > 0 ? [] : planLayers(this.manifest);
    const last = plans.at(-1);
    const layers = last ? last.layer + (last.form === 'byte-pairs' ? 2 : 1) : Math.ceil(this.manifest.planes.length / 4);
    const textures: SurfaceTextures = {
      planes: last ? planesTexture(this.manifest.width, this.manifest.height, layers, last.form) : null,
      transfer: null, largest: 255, clusters: null, exact: last?.form === 'byte-pairs', albedo: null, opacity: null, layers,
    };
    // Asks for everything at once, first for what the first picture needs.
    const mesh = this.mesh();
    const decoded = plans.map((plan) => this.layer(plan));
    const tables = this.tables();
    const maps = this.maps(textures);
    const parts = Promise.all([mesh, tables, maps]);
    const all = Promise.all([parts, ...decoded]);
    all.catch(() => {});
    await (progressive && decoded.length > 0 ? Promise.all([parts, decoded[0]]) : all);
    const { geometry, transfer } = await mesh;
    textures.transfer = transfer;
    const places = transfer
      ? this.manifest.planes.map((plane, k): PlanePlace => ({ plane, layer: k >> 2, channel: k & 3, deep: false, factor: 1, ready: true }))
      : plans.flatMap((plan) => plan.places);
    if (transfer) textures.largest = 2 ** this.manifest.planes[0].bits - 1;
    const asset = new KilnAsset({ source: this.source, manifest: this.manifest, geometry, textures, places, tables: await tables });
    asset.bytes = this.progress.loaded;
    const received = Promise.all(plans.map(async (plan, k) => asset.receive(plan.layer, await decoded[k])));
    asset.ready = Promise.all([received, all]).then(() => void (asset.bytes = this.progress.loaded));
    asset.ready.catch(() => {});
    if (!progressive) await asset.ready;
    return asset;
  }

  private async bytes(name: string): Promise<Uint8Array> {
    ++this.progress.fileCount;
    const bytes = await this.source.bytes(name);
    ++this.progress.files;
    this.progress.loaded += bytes.byteLength;
    this.onProgress(this.progress);
    return bytes;
  }

  private nameOf(file: string): string {
    return `${this.source.name}/${file}`;
  }

  private async mesh() {
    const { manifest } = this;
    const file = this.nameOf(manifest.mesh);
    if (this.source.geometry) {
      const geometry = checkGeometry(await this.source.geometry(), manifest, file);
      const names = this.source.vertexAttributes ?? new Map<string, string>();
      return { geometry, transfer: manifest.vertices > 0 ? vertexTransferOf(geometry, names, manifest, file) : null };
    }
    const bytes = await this.bytes(manifest.mesh);
    const geometry = await decodeMesh(bytes, manifest, file);
    return { geometry, transfer: manifest.vertices > 0 ? await decodeVertexTransfer(bytes, manifest, file) : null };
  }

  private async layer(plan: LayerPlan): Promise<(Uint8Array | Float32Array)[]> {
    const { width, height } = this.manifest;
    const pictures = await Promise.all(plan.places.map(async ({ plane }) => ({
      file: this.nameOf(plane.file), bytes: await this.bytes(plane.file), width, height, bits: plane.bits,
    })));
    const { layers, factors } = await pngDecoder.layers(pictures, plan.form, this.manifest.clusters !== null);
    plan.places.forEach((place, k) => (place.factor = factors[k]));
    return layers;
  }

  private async tables(): Promise<ClusterTables | null> {
    const { clusters, channels, bands } = this.manifest;
    if (!clusters) return null;
    const bytes = await this.bytes(clusters.vectorsFile);
    const size = { width: channels * bands * bands, height: clusters.count * (clusters.components + 1) };
    const stored = await pngDecoder.numbers({ file: this.nameOf(clusters.vectorsFile), bytes, ...size, bits: 16 });
    // The table counts its rows from the top.
    const fromTop = new Uint16Array(stored.length);
    for (let row = 0; row < size.height; ++row) fromTop.set(stored.subarray((size.height - 1 - row) * size.width, (size.height - row) * size.width), row * size.width);
    return clusterTables(this.manifest, fromTop);
  }

  private async maps(textures: SurfaceTextures): Promise<void> {
    const { manifest } = this;
    const { width, height, clusters } = manifest;
    const albedo = async () => {
      if (typeof manifest.albedo !== 'string') return;
      const own = manifest.json['albedo_width'] !== undefined;
      const size = own ? { width: Number(manifest.json['albedo_width']), height: Number(manifest.json['albedo_height']) } : { width, height };
      textures.albedo = await pictureTexture(await this.bytes(manifest.albedo), this.nameOf(manifest.albedo), 'color', size, own);
    };
    const opacity = async () => {
      if (manifest.opacity) textures.opacity = await pictureTexture(await this.bytes(manifest.opacity), this.nameOf(manifest.opacity), this.source.isGltf ? 'alpha' : 'data', null);
    };
    const ids = async () => {
      if (!clusters?.idsFile) return;
      const file = this.nameOf(clusters.idsFile);
      const values = await pngDecoder.numbers({ file, bytes: await this.bytes(clusters.idsFile), width, height, bits: 8 });
      if (values.some((id) => id >= clusters.count))
        throw new KilnError(file, 'a cluster that is not there', `numbers below ${clusters.count}`, 'Copy the folder anew.');
      const texture = new DataTexture(values as Uint8Array<ArrayBuffer>, width, height, RedIntegerFormat, UnsignedByteType);
      texture.internalFormat = 'R8UI';
      texture.minFilter = texture.magFilter = NearestFilter;
      texture.unpackAlignment = 1;
      texture.needsUpdate = true;
      textures.clusters = texture;
    };
    await Promise.all([albedo(), opacity(), ids()]);
  }
}
