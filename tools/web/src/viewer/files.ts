// SPDX-License-Identifier: MIT
// Files that were dropped or chosen: folders of assets, .glb and .hdr.
import { GlbSource } from '../glb';
import { type AssetSource, FilesSource } from '../sources';

export interface Dropped {
  sources: AssetSource[];
  environments: File[];
}

type Paths = [string, File][];

async function walk(entry: FileSystemEntry, into: Paths): Promise<void> {
  if (entry.isFile) {
    const file = await new Promise<File>((resolve, reject) => (entry as FileSystemFileEntry).file(resolve, reject));
    into.push([entry.fullPath.replace(/^\//, ''), file]);
    return;
  }
  const reader = (entry as FileSystemDirectoryEntry).createReader();
  for (;;) {
    const entries = await new Promise<FileSystemEntry[]>((resolve, reject) => reader.readEntries(resolve, reject));
    if (entries.length === 0) return;
    for (const each of entries) await walk(each, into);
  }
}

/** Reads what was dropped, folders with all that they hold. */
export async function filesOfDrop(transfer: DataTransfer): Promise<Paths> {
  const entries = [...transfer.items].map((item) => item.webkitGetAsEntry?.() ?? null);
  const plain = [...transfer.files];
  const paths: Paths = [];
  if (entries.some((entry) => entry !== null)) for (const entry of entries) if (entry) await walk(entry, paths);
  return paths.length > 0 ? paths : plain.map((file) => [file.name, file]);
}

export function filesOfInput(input: HTMLInputElement): Paths {
  return [...(input.files ?? [])].map((file) => [file.webkitRelativePath || file.name, file]);
}

/** Finds assets and environments among files. */
export async function sortFiles(paths: Paths): Promise<Dropped> {
  const dropped: Dropped = { sources: [], environments: [] };
  const folders = new Set<string>();
  for (const [path, file] of paths) {
    if (/\.glb$/i.test(path)) dropped.sources.push(new GlbSource(new Uint8Array(await file.arrayBuffer()), {}, 'same-origin', path));
    else if (/\.hdr$/i.test(path)) dropped.environments.push(file);
    else if (/(^|\/)(ranges|pca)\.json$/.test(path)) folders.add(path.replace(/[^/]*$/, ''));
  }
  for (const folder of [...folders].sort()) {
    const files = new Map(paths.filter(([path]) => path.startsWith(folder)).map(([path, file]) => [path.slice(folder.length), file]));
    dropped.sources.push(new FilesSource(folder.replace(/\/$/, '') || 'dropped files', files));
  }
  return dropped;
}
