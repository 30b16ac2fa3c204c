// SPDX-License-Identifier: MIT
import {
  BufferAttribute, type BufferGeometry, DataTexture, NearestFilter, RGBAIntegerFormat, UnsignedByteType, UnsignedShortType,
} from 'three';
import { decodeDraco } from './draco';
import { KilnError } from './errors';
import type { Manifest } from './manifest';

const remedy = 'Copy the folder anew, or run `kiln check` on it.';

/** Throws KilnError unless a geometry is what the manifest says. */
export function checkGeometry(geometry: BufferGeometry, manifest: Manifest, file: string): BufferGeometry {
  const { position, normal, uv } = geometry.attributes;
  if (!position || !geometry.index || geometry.index.count === 0) throw new KilnError(file, 'no triangles', 'a mesh', remedy);
  if (!normal) throw new KilnError(file, 'a mesh without normals', 'normals', remedy);
  if (manifest.vertices === 0 && !uv) throw new KilnError(file, 'a mesh without uvs', 'uvs', remedy);
  if (manifest.vertices > 0 && position.count !== manifest.vertices)
    throw new KilnError(file, `${position.count} vertices`, `${manifest.vertices}, as ${manifest.file} says`, remedy);
  geometry.computeBoundingBox();
  geometry.computeBoundingSphere();
  return geometry;
}

/** Decodes an asset's mesh: its first uvs are those of the pictures. */
export async function decodeMesh(bytes: Uint8Array, manifest: Manifest, file: string): Promise<BufferGeometry> {
  const geometry = await decodeDraco(bytes, file, {
    attributeIDs: manifest.vertices > 0 ? { position: 'POSITION', normal: 'NORMAL' } : { position: 'POSITION', normal: 'NORMAL', uv: 'TEX_COORD' },
    attributeTypes: { position: 'Float32Array', normal: 'Float32Array', uv: 'Float32Array' },
    useUniqueIDs: false,
  });
  return checkGeometry(geometry, manifest, file);
}

/** Decodes the transfer of vertices into a texture of unsigned integers: vertex after vertex, its layers of four. */
export async function decodeVertexTransfer(bytes: Uint8Array, manifest: Manifest, file: string): Promise<DataTexture> {
  const bits = manifest.planes[0].bits;
  const ids = [...new Set(manifest.planes.map((plane) => plane.uniqueId))];
  const geometry = await decodeDraco(bytes, file, {
    attributeIDs: Object.fromEntries(ids.map((id) => [`kiln${id}`, id])),
    attributeTypes: Object.fromEntries(ids.map((id) => [`kiln${id}`, bits === 8 ? 'Uint8Array' : 'Uint16Array'])),
    useUniqueIDs: true,
  });
  const columns = manifest.planes.map((plane) => {
    const attribute = geometry.attributes[`kiln${plane.uniqueId}`];
    if (!attribute || attribute.count !== manifest.vertices || attribute.itemSize <= plane.component)
      throw new KilnError(file, `no component ${plane.component} of an attribute ${plane.uniqueId}`, `one of ${manifest.vertices} vertices`, remedy);
    return attribute;
  });
  return transferTexture(manifest, (plane, vertex) => columns[plane].getComponent(vertex, manifest.planes[plane].component));
}

/** Takes the transfer of vertices from the attributes of a mesh. */
export function vertexTransferOf(geometry: BufferGeometry, names: ReadonlyMap<string, string>, manifest: Manifest, file: string): DataTexture {
  const columns = manifest.planes.map((plane) => {
    const attribute = geometry.attributes[names.get(plane.attribute) ?? ''];
    if (!attribute || attribute.itemSize <= plane.component)
      throw new KilnError(file, `no component ${plane.component} of ${plane.attribute}`, 'the transfer of vertices', 'Export the asset anew by `kiln export`.');
    return attribute;
  });
  return transferTexture(manifest, (plane, vertex) => columns[plane].getComponent(vertex, manifest.planes[plane].component));
}

/** Packs numbers of vertices, by plane and vertex, into the texture that prt.vert.glsl reads. */
export function transferTexture(manifest: Manifest, stored: (plane: number, vertex: number) => number): DataTexture {
  const deep = manifest.planes[0].bits === 16;
  const layers = Math.ceil(manifest.planes.length / 4);
  const width = 2048;
  const height = Math.ceil((manifest.vertices * layers) / width);
  const values = deep ? new Uint16Array(4 * width * height) : new Uint8Array(4 * width * height);
  for (let plane = 0; plane < manifest.planes.length; ++plane)
    for (let vertex = 0; vertex < manifest.vertices; ++vertex) values[4 * vertex * layers + plane] = stored(plane, vertex);
  const texture = new DataTexture(values, width, height, RGBAIntegerFormat, deep ? UnsignedShortType : UnsignedByteType);
  texture.internalFormat = deep ? 'RGBA16UI' : 'RGBA8UI';
  texture.minFilter = texture.magFilter = NearestFilter;
  texture.needsUpdate = true;
  return texture;
}

/** Numbers the parts of a mesh that share no vertex: charts, where the mesh is split at the seams of its atlas. */
export function chartOfVertex(geometry: BufferGeometry): Uint32Array {
  const parent = Uint32Array.from({ length: geometry.attributes.position.count }, (_, v) => v);
  const root = (v: number) => {
    while (parent[v] !== v) v = parent[v] = parent[parent[v]];
    return v;
  };
  const index = geometry.index!;
  for (let i = 0; i < index.count; i += 3) {
    const a = root(index.getX(i));
    parent[root(index.getX(i + 1))] = a;
    parent[root(index.getX(i + 2))] = a;
  }
  const number = new Map<number, number>();
  return parent.map((_, v) => {
    const at = root(v);
    if (!number.has(at)) number.set(at, number.size);
    return number.get(at)!;
  });
}

/** Adds a colour for each chart, the attribute `kiln_chart`; returns how many charts there are. */
export function addChartColors(geometry: BufferGeometry): number {
  const charts = chartOfVertex(geometry);
  const colors = new Float32Array(3 * charts.length);
  let most = 0;
  charts.forEach((chart, v) => {
    most = Math.max(most, chart + 1);
    const hue = 6 * ((0.08 + 0.6180339887498949 * chart) % 1);
    const lightness = chart % 2 === 0 ? 0.92 : 0.72;
    for (let c = 0; c < 3; ++c) {
      const ramp = Math.min(1, Math.max(0, Math.abs(((hue + [0, 4, 2][c]) % 6) - 3) - 1));
      colors[3 * v + c] = (lightness * (1 - 0.62 * (1 - ramp))) ** 2.2;
    }
  });
  geometry.setAttribute('kiln_chart', new BufferAttribute(colors, 3));
  return most;
}
