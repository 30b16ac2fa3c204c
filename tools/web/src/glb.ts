// SPDX-License-Identifier: MIT
// A binary glTF of `kiln export`: an ordinary mesh, and transfer under the extension KILN_prt of its material.
import { type BufferGeometry, Mesh } from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { MeshoptDecoder } from 'three/addons/libs/meshopt_decoder.module.js';
import { dracoLoader } from './draco';
import { KilnError } from './errors';
import type { AssetSource } from './sources';

const extensionName = 'KILN_prt';
const remedy = 'Export the asset anew by `kiln export`.';

interface TextureInfo {
  index: number;
}

interface Extension {
  version: number;
  manifest: Record<string, unknown>;
  pictures?: Record<string, TextureInfo>;
  /** Per vertex: attributes of the primitive by those of the planes. */
  attributes?: Record<string, string>;
}

interface GltfJson {
  materials?: { extensions?: Record<string, unknown>; normalTexture?: TextureInfo; pbrMetallicRoughness?: { baseColorTexture?: TextureInfo } }[];
  meshes?: { primitives: { material?: number }[] }[];
  textures?: { source?: number }[];
  images?: { bufferView?: number; uri?: string }[];
  bufferViews?: { buffer: number; byteOffset?: number; byteLength: number }[];
}

/** Reads the chunks of a binary glTF. */
function chunksOf(bytes: Uint8Array, name: string): { json: GltfJson; binary: Uint8Array } {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  if (bytes.byteLength < 20 || view.getUint32(0, true) !== 0x46546c67) throw new KilnError(name, 'no binary glTF', 'a .glb', remedy);
  const parts: Uint8Array[] = [];
  for (let at = 12; at + 8 <= bytes.byteLength; ) {
    const length = view.getUint32(at, true);
    if (at + 8 + length > bytes.byteLength) throw new KilnError(name, 'a file that ends early', 'all of it', 'Copy it anew.');
    parts.push(bytes.subarray(at + 8, at + 8 + length));
    at += 8 + length;
  }
  try {
    return { json: JSON.parse(new TextDecoder().decode(parts[0])) as GltfJson, binary: parts[1] ?? new Uint8Array() };
  } catch {
    throw new KilnError(name, 'a .glb whose JSON cannot be read', 'a sound one', remedy);
  }
}

/** A .glb, by its address or as bytes. */
export class GlbSource implements AssetSource {
  readonly name: string;
  /** Names of a geometry's attributes by those of planes, per vertex. */
  vertexAttributes = new Map<string, string>();
  private loaded: { file: Uint8Array; json: GltfJson; binary: Uint8Array; extension: Extension; material: number } | null = null;

  constructor(
    private readonly content: string | Uint8Array,
    private readonly headers: Record<string, string> = {},
    private readonly credentials: RequestCredentials = 'same-origin',
    name = '',
  ) {
    this.name = name || (typeof content === 'string' ? decodeURIComponent(content.replace(/[?#].*$/, '')) : 'asset.glb');
  }

  /** Its opacity is the alpha of its colours; its normals are in tangent space, whatever the manifest says. */
  readonly isGltf = true;

  async manifest() {
    const file = typeof this.content === 'string' ? await this.fetch(this.content) : this.content;
    const { json, binary } = chunksOf(file, this.name);
    const material = (json.materials ?? []).findIndex((each) => each.extensions?.[extensionName]);
    if (material < 0)
      throw new KilnError(this.name, `no extension ${extensionName}`, 'a .glb of `kiln export`', 'Tools that do not know the extension delete it; export the asset anew.');
    const extension = json.materials![material].extensions![extensionName] as Extension;
    if (extension.version !== 1) throw new KilnError(this.name, `version ${extension.version} of ${extensionName}`, 'version 1', 'Use a newer viewer.');
    this.loaded = { file, json, binary, extension, material };
    this.vertexAttributes = new Map(Object.entries(extension.attributes ?? {}).map(([plane, name]) => [plane, name.toLowerCase()]));
    return { json: extension.manifest, file: extensionName };
  }

  private async fetch(address: string): Promise<Uint8Array> {
    let response;
    try {
      response = await fetch(new URL(address, document.baseURI), { headers: this.headers, credentials: this.credentials });
    } catch (error) {
      throw new KilnError(this.name, `no answer (${error instanceof Error ? error.message : String(error)})`, 'the file', 'See whether the server runs.');
    }
    if (!response.ok) throw new KilnError(this.name, `status ${response.status} of the server`, 'the file', 'See whether the file is there.');
    return new Uint8Array(await response.arrayBuffer());
  }

  // The base colour and the normal map may stand in their usual places alone.
  private textureOf(name: string): TextureInfo | undefined {
    const { extension, json, material } = this.loaded!;
    const plain = json.materials![material];
    if (extension.pictures?.[name]) return extension.pictures[name];
    if (name === extension.manifest['albedo'] || name === extension.manifest['opacity']) return plain.pbrMetallicRoughness?.baseColorTexture;
    if (name === extension.manifest['normals']) return plain.normalTexture;
    return undefined;
  }

  bytes(name: string): Promise<Uint8Array> {
    const { json, binary } = this.loaded!;
    const texture = this.textureOf(name);
    const image = json.images?.[json.textures?.[texture?.index ?? -1]?.source ?? -1];
    const view = json.bufferViews?.[image?.bufferView ?? -1];
    if (!view) return Promise.reject(new KilnError(`${this.name}/${name}`, 'no such picture', 'a picture inside the file', remedy));
    const begin = view.byteOffset ?? 0;
    return Promise.resolve(binary.slice(begin, begin + view.byteLength));
  }

  async geometry(): Promise<BufferGeometry> {
    const { file, json, material } = this.loaded!;
    // three.js need not decode the pictures: they are read by bytes().
    const loader = new GLTFLoader().setDRACOLoader(dracoLoader()).setMeshoptDecoder(MeshoptDecoder);
    let found: BufferGeometry | null = null;
    try {
      const gltf = await loader.parseAsync(withoutPictures(file, json), '');
      gltf.scene.traverse((object) => {
        if (!found && object instanceof Mesh && (gltf.parser.associations.get(object.material as never)?.materials === material || json.materials!.length === 1))
          found = object.geometry as BufferGeometry;
      });
    } catch (error) {
      throw new KilnError(this.name, `a mesh that cannot be read (${error instanceof Error ? error.message : String(error)})`, 'a sound glTF', remedy);
    }
    if (!found) throw new KilnError(this.name, 'no mesh that has the material', 'one', remedy);
    return upwards(found);
  }
}

/** Returns the file with materials that name no texture. */
function withoutPictures(file: Uint8Array, json: GltfJson): ArrayBuffer {
  const bare = { ...json, materials: (json.materials ?? []).map(() => ({})), textures: undefined, images: undefined, extensionsRequired: undefined };
  const text = new TextEncoder().encode(JSON.stringify(bare));
  const padded = (text.length + 3) & ~3;
  const view = new DataView(file.buffer, file.byteOffset, file.byteLength);
  const rest = file.subarray(20 + view.getUint32(12, true));
  const out = new Uint8Array(20 + padded + rest.length).fill(0x20);
  out.set(file.subarray(0, 20));
  out.set(text, 20);
  out.set(rest, 20 + padded);
  const header = new DataView(out.buffer);
  header.setUint32(8, out.length, true);
  header.setUint32(12, padded, true);
  return out.buffer;
}

/** Turns glTF's v, which goes down, into ours. */
function upwards(geometry: BufferGeometry): BufferGeometry {
  const uv = geometry.attributes.uv;
  if (uv) for (let i = 0; i < uv.count; ++i) uv.setY(i, 1 - uv.getY(i));
  return geometry;
}
