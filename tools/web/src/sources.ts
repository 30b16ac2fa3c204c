// SPDX-License-Identifier: MIT
// Where an asset's files come from: a folder over HTTP, files that were dropped, or a binary glTF (glb.ts).
import type { BufferGeometry } from 'three';
import { KilnError } from './errors';

/** What the loader needs of an asset. */
export interface AssetSource {
  /** Name for people. */
  readonly name: string;
  /** Returns the parsed ranges.json or pca.json, and that file's name. */
  manifest(): Promise<{ json: unknown; file: string }>;
  /** Returns a file that the manifest names; the caller may change the bytes. */
  bytes(name: string): Promise<Uint8Array>;
  /** Returns the mesh where it is no file: positions, normals, and uvs whose v goes up. */
  geometry?(): Promise<BufferGeometry>;
  /** Per vertex, the attributes of that mesh, by the names that planes have. */
  readonly vertexAttributes?: ReadonlyMap<string, string>;
  /** A glTF: opacity is the alpha of the colours, and normals are in tangent space. */
  readonly isGltf?: boolean;
}

const manifestNames = ['ranges.json', 'pca.json'];

function parseManifest(bytes: Uint8Array, file: string): unknown {
  try {
    return JSON.parse(new TextDecoder('utf-8', { fatal: true }).decode(bytes));
  } catch (error) {
    throw new KilnError(file, `no JSON (${error instanceof Error ? error.message : String(error)})`, 'what kiln-bake wrote', 'Copy the folder anew.');
  }
}

/** A folder on a server: its address, or that of its ranges.json or pca.json. */
export class HttpSource implements AssetSource {
  readonly name: string;
  private readonly folder: URL;
  private readonly wanted: string[];

  constructor(
    address: string,
    private readonly headers: Record<string, string> = {},
    private readonly credentials: RequestCredentials = 'same-origin',
    private readonly signal?: AbortSignal,
  ) {
    const url = new URL(address, document.baseURI);
    const last = url.pathname.slice(url.pathname.lastIndexOf('/') + 1);
    this.wanted = last.endsWith('.json') ? [last] : manifestNames;
    if (!last.endsWith('.json') && last !== '') url.pathname += '/';
    this.folder = new URL('.', url);
    this.folder.search = url.search;
    this.name = decodeURIComponent(address.replace(/[?#].*$/, '').replace(/\/?([^/]*\.json)?$/, '')) || this.folder.host;
  }

  async manifest() {
    for (const file of this.wanted) {
      const bytes = await this.get(file, this.wanted.length > 1);
      if (bytes) return { json: parseManifest(bytes, `${this.name}/${file}`), file };
    }
    throw new KilnError(this.name, 'neither ranges.json nor pca.json', 'a folder of kiln-bake or kiln-compress', 'Name that folder, often called prt.');
  }

  async bytes(name: string): Promise<Uint8Array> {
    return (await this.get(name, false))!;
  }

  /** Returns null where the file is not there and `optional`. */
  private async get(name: string, optional: boolean): Promise<Uint8Array | null> {
    const url = new URL(name.split('/').map(encodeURIComponent).join('/'), this.folder);
    url.search = this.folder.search;
    let response;
    try {
      response = await fetch(url, { headers: this.headers, credentials: this.credentials, signal: this.signal });
      if (response.ok) return new Uint8Array(await response.arrayBuffer());
    } catch (error) {
      if (error instanceof DOMException && error.name === 'AbortError') throw error;
      throw new KilnError(`${this.name}/${name}`, `no answer (${error instanceof Error ? error.message : String(error)})`, 'the file', 'See whether the server runs.');
    }
    if (optional && (response.status === 404 || response.status === 403)) return null;
    throw new KilnError(`${this.name}/${name}`, `status ${response.status} of the server`, 'the file', response.status === 404 ? 'Copy the whole folder to the server.' : 'See what the server says.');
  }
}

/** Files that are at hand, by their path inside the folder. */
export class FilesSource implements AssetSource {
  constructor(
    readonly name: string,
    private readonly files: ReadonlyMap<string, Blob>,
  ) {}

  async manifest() {
    for (const file of [...manifestNames].reverse())
      if (this.files.has(file)) return { json: parseManifest(await this.bytes(file), `${this.name}/${file}`), file };
    throw new KilnError(this.name, 'neither ranges.json nor pca.json', 'all files of a folder of kiln-bake or kiln-compress', 'Drop the whole folder.');
  }

  async bytes(name: string): Promise<Uint8Array> {
    const file = this.files.get(name);
    if (!file) throw new KilnError(`${this.name}/${name}`, 'no such file', 'the file that the folder names', 'Drop the whole folder.');
    return new Uint8Array(await file.arrayBuffer());
  }
}
