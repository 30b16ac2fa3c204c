// SPDX-License-Identifier: MIT
// Reads ranges.json and pca.json, of versions 1 and 2 (docs/format.md), and refuses what it would draw wrong.
import { KilnError } from './errors';

/** A picture, or a component of a vertex attribute, that holds one number of every texel or vertex. */
export interface Plane {
  /** Name of a PNG; empty per vertex. */
  file: string;
  /** Draco's unique id of the attribute, and the component of it; per vertex only. */
  uniqueId: number;
  /** Name of the attribute. */
  attribute: string;
  component: number;
  channel: number;
  coefficient: number;
  bits: 8 | 16;
  min: number;
  max: number;
}

export interface Clusters {
  count: number;
  components: number;
  /** Picture of the cluster of every texel; empty where there is one. */
  idsFile: string;
  coefficientScales: number[];
  vectorsFile: string;
  vectorRanges: { min: number; max: number }[];
}

/** What a folder says of itself. */
export interface Manifest {
  /** Name of the file it stands in, for messages. */
  file: string;
  bands: number;
  channels: 1 | 3;
  /** Texels; 0 per vertex. */
  width: number;
  height: number;
  /** Vertices; 0 where there are pictures. */
  vertices: number;
  mesh: string;
  /** Name of the normal map; empty where there is none. */
  normals: string;
  tangentNormals: boolean;
  /** Linear reflectance, name of an sRGB-encoded picture, or null where it is not known. */
  albedo: [number, number, number] | string | null;
  opacity: string;
  planes: Plane[];
  clusters: Clusters | null;
  /** Everything else that the file says. */
  json: Record<string, unknown>;
}

/** Names of `requires` that this reader knows. */
const known = ['vertices', 'tangent_normals', 'albedo', 'albedo_size', 'normal_size', 'opacity'];

const remake = 'Bake the asset anew, or run `kiln check` on its folder.';

class Reader {
  constructor(
    readonly file: string,
    readonly json: Record<string, unknown>,
  ) {}

  fail(found: string, expected: string, remedy = remake): never {
    throw new KilnError(this.file, found, expected, remedy);
  }

  integer(key: string, low: number, high: number, json = this.json): number {
    const value = json[key];
    if (typeof value !== 'number' || !Number.isInteger(value) || value < low || value > high)
      this.fail(`${JSON.stringify(value) ?? 'nothing'} as "${key}"`, `a whole number of ${low} to ${high}`);
    return value;
  }

  number(key: string, json = this.json): number {
    const value = json[key];
    if (typeof value !== 'number' || !Number.isFinite(value))
      this.fail(`${JSON.stringify(value) ?? 'nothing'} as "${key}"`, 'a number');
    return value;
  }

  name(key: string, json = this.json): string {
    const value = json[key];
    if (typeof value !== 'string' || value === '') this.fail(`${JSON.stringify(value) ?? 'nothing'} as "${key}"`, 'the name of a file');
    if (/^\/|(^|\/)\.\.(\/|$)|[\x00-\x1f\\]|^[a-z][a-z0-9+.-]*:/i.test(value))
      this.fail(`"${value}" as "${key}"`, 'a path inside the folder');
    return value;
  }

  optionalName(key: string): string {
    return this.json[key] === undefined ? '' : this.name(key);
  }

  list(key: string): Record<string, unknown>[] {
    const value = this.json[key];
    if (!Array.isArray(value) || value.length === 0 || value.some((v) => typeof v !== 'object' || v === null))
      this.fail(`${value === undefined ? 'nothing' : 'no list of objects'} as "${key}"`, 'a list');
    return value as Record<string, unknown>[];
  }

  colors(): 1 | 3 {
    const value = this.integer('channels', 1, 64);
    if (value !== 1 && value !== 3) this.fail(`${value} channels, a spectral asset`, '1 channel or 3', 'Bake the asset with 1 channel or 3.');
    return value;
  }

  bits(json = this.json): 8 | 16 {
    const value = json['bits'];
    if (value !== 8 && value !== 16) this.fail(`${JSON.stringify(value) ?? 'nothing'} as "bits"`, '8 or 16');
    return value;
  }

  range(json: Record<string, unknown>): { min: number; max: number } {
    const min = this.number('min', json);
    const max = this.number('max', json);
    if (max < min) this.fail(`a range of ${min} to ${max}`, 'one whose max is not below its min');
    return { min, max };
  }

  albedo(): Manifest['albedo'] {
    const value = this.json['albedo'];
    if (value === undefined) return null;
    if (typeof value === 'string') return this.name('albedo');
    if (!Array.isArray(value) || value.length !== 3 || value.some((v) => typeof v !== 'number' || !(v >= 0 && v <= 1)))
      this.fail(`${JSON.stringify(value)} as "albedo"`, 'three numbers of 0 to 1, or the name of a picture');
    return [value[0], value[1], value[2]];
  }
}

/** Checks format, version, basis and `requires`. */
function checkHeader(reader: Reader): void {
  const { json } = reader;
  if (json['format'] === 'kiln-probes')
    reader.fail('probes', 'an asset', 'Open the folder of kiln-bake or kiln-compress.');
  if (json['format'] !== 'kiln-prt' && json['format'] !== 'kiln-prt-pca')
    reader.fail(`format ${JSON.stringify(json['format']) ?? 'none'}`, '"kiln-prt" or "kiln-prt-pca"', 'Open a folder that Kiln baked.');
  if (json['version'] !== 1 && json['version'] !== 2)
    reader.fail(`version ${JSON.stringify(json['version']) ?? 'none'}`, 'version 1 or 2', 'Use a newer viewer, or bake the asset anew.');
  if (json['basis'] !== 'real-sh-orthonormal')
    reader.fail(`basis ${JSON.stringify(json['basis']) ?? 'none'}`, '"real-sh-orthonormal"', 'Use a newer viewer.');
  const requires = json['requires'] ?? (json['version'] === 1 ? [] : undefined);
  if (!Array.isArray(requires) || requires.some((name) => typeof name !== 'string'))
    reader.fail(`${JSON.stringify(requires) ?? 'nothing'} as "requires"`, 'a list of names');
  const unknown = (requires as string[]).filter((name) => !known.includes(name));
  if (unknown.length > 0)
    reader.fail(`"requires" names ${unknown.join(', ')}, which this reader does not know`, known.join(', '), 'Use a newer viewer.');
}

/** Reads planes of pictures, sorted by channel and coefficient. */
function picturePlanes(reader: Reader, channels: number, coefficients: number): Plane[] {
  const bits = reader.bits();
  const vertex = reader.json['vertices'] !== undefined;
  const planes = reader.list('planes').map((json): Plane => ({
    file: vertex ? '' : reader.name('file', json),
    uniqueId: vertex ? reader.integer('unique_id', 0, 1e6, json) : 0,
    attribute: vertex ? reader.name('attribute', json) : '',
    component: vertex ? reader.integer('component', 0, 3, json) : 0,
    channel: reader.integer('channel', 0, channels - 1, json),
    coefficient: reader.integer('coefficient', 0, coefficients - 1, json),
    bits,
    ...reader.range(json),
  }));
  const places = new Set(planes.map((plane) => plane.channel * coefficients + plane.coefficient));
  if (planes.length !== channels * coefficients || places.size !== planes.length)
    reader.fail(`${planes.length} planes`, `${channels * coefficients}: each coefficient of each channel once`);
  return planes;
}

function clustersOf(reader: Reader, channels: number, coefficients: number): Clusters {
  const count = reader.integer('clusters', 1, 256);
  const components = reader.integer('components', 1, channels * coefficients);
  const scales = reader.json['coefficient_scales'];
  if (!Array.isArray(scales) || scales.length !== coefficients || scales.some((v) => typeof v !== 'number'))
    reader.fail('other "coefficient_scales"', `${coefficients} numbers`);
  const ranges = reader.list('vector_ranges').map((json) => reader.range(json));
  if (ranges.length !== components + 1) reader.fail(`${ranges.length} "vector_ranges"`, `${components + 1}`);
  return {
    count,
    components,
    idsFile: count > 1 ? reader.name('cluster_ids') : '',
    coefficientScales: scales as number[],
    vectorsFile: reader.name('vectors_file'),
    vectorRanges: ranges,
  };
}

/** Reads what was parsed of a `ranges.json` or `pca.json`; `file` names it in messages. Throws KilnError. */
export function readManifest(json: unknown, file: string): Manifest {
  if (typeof json !== 'object' || json === null || Array.isArray(json))
    throw new KilnError(file, 'no JSON object', 'what kiln-bake wrote', remake);
  const reader = new Reader(file, json as Record<string, unknown>);
  checkHeader(reader);
  const compressed = reader.json['format'] === 'kiln-prt-pca';
  const bands = reader.integer('bands', 1, 24);
  const channels = reader.colors();
  const coefficients = bands * bands;
  const vertices = compressed || reader.json['vertices'] === undefined ? 0 : reader.integer('vertices', 1, 1e9);
  const clusters = compressed ? clustersOf(reader, channels, coefficients) : null;
  const planes = clusters
    ? reader.list('planes').map((plane, j): Plane => ({
        file: reader.name('file', plane), uniqueId: 0, attribute: '', component: 0, channel: 0, coefficient: j,
        bits: reader.bits(plane), ...reader.range(plane),
      }))
    : picturePlanes(reader, channels, coefficients);
  if (clusters && planes.length !== clusters.components) reader.fail(`${planes.length} planes`, `${clusters.components}, one for each component`);
  const albedo = reader.albedo();
  if (vertices > 0 && typeof albedo === 'string') reader.fail('a picture as "albedo"', 'three numbers, where transfer is per vertex');
  const space = reader.json['normal_space'];
  if (space !== undefined && space !== 'object' && space !== 'tangent') reader.fail(`${JSON.stringify(space)} as "normal_space"`, '"object" or "tangent"');
  return {
    file,
    bands,
    channels,
    width: vertices > 0 ? 0 : reader.integer('width', 1, 16384),
    height: vertices > 0 ? 0 : reader.integer('height', 1, 16384),
    vertices,
    mesh: reader.name('mesh'),
    normals: reader.optionalName('normals'),
    tangentNormals: space === 'tangent',
    albedo,
    opacity: reader.optionalName('opacity'),
    planes,
    clusters,
    json: reader.json,
  };
}
