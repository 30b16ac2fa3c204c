// SPDX-License-Identifier: MIT
// three.js's own Draco decoder, bundled, so that no file but the asset's is asked for.
import { type BufferGeometry } from 'three';
import { DRACOLoader } from 'three/addons/loaders/DRACOLoader.js';
import wrapper from 'three/examples/jsm/libs/draco/gltf/draco_wasm_wrapper.js?raw';
import wasm from 'three/examples/jsm/libs/draco/gltf/draco_decoder.wasm?base64';
import { KilnError } from './errors';

function bytesOfBase64(text: string): ArrayBuffer {
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes.buffer;
}

interface DecodeTask {
  attributeIDs: Record<string, string | number>;
  attributeTypes: Record<string, string>;
  useUniqueIDs: boolean;
}

class BundledDracoLoader extends DRACOLoader {
  // Hands out the decoder that is part of this file; the base class would fetch it.
  protected _loadLibrary(_url: string, type: string): Promise<string | ArrayBuffer> {
    return Promise.resolve(type === 'text' ? wrapper : bytesOfBase64(wasm));
  }
}

interface Workers {
  workerNextTaskID: number;
  _getWorker(task: number, cost: number): Promise<Worker>;
  _releaseTask(worker: Worker, task: number): void;
}

let shared: BundledDracoLoader | null = null;

/** Returns the decoder that all loaders share. */
export function dracoLoader(): DRACOLoader {
  shared ??= new BundledDracoLoader().setWorkerLimit(2) as BundledDracoLoader;
  return shared;
}

/** Starts the decoder, so that it is there when the mesh is. */
export function warmDraco(): void {
  if (shared) return;
  const loader = dracoLoader() as unknown as Workers;
  const task = loader.workerNextTaskID++;
  void loader._getWorker(task, 0).then((worker) => loader._releaseTask(worker, task));
}

/** Decodes a Draco mesh: attributes by their semantic, or by unique id. Rejects with KilnError. */
export async function decodeDraco(bytes: Uint8Array, file: string, task: DecodeTask): Promise<BufferGeometry> {
  const loader = dracoLoader() as unknown as { decodeGeometry(buffer: ArrayBuffer, task: DecodeTask): Promise<BufferGeometry> };
  const copy = bytes.slice().buffer as ArrayBuffer;
  if (new TextDecoder('latin1').decode(copy.slice(0, 5)) !== 'DRACO')
    throw new KilnError(file, 'no Draco mesh', 'a mesh of kiln-atlas or kiln-bake', 'Copy the folder anew, or run `kiln check` on it.');
  try {
    return await loader.decodeGeometry(copy, task);
  } catch (error) {
    const text = error instanceof Error ? error.message : String((error as { error?: unknown }).error ?? error);
    throw new KilnError(file, `a mesh that cannot be decoded (${text})`, 'a sound Draco mesh', 'Copy the folder anew, or run `kiln check` on it.');
  }
}
