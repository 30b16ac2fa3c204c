// SPDX-License-Identifier: GPL-3.0-or-later
// xatlas beside kiln-atlas: unwraps an OBJ file of triangles and writes it with uvs, for `bench_atlas --measure`.
//
//   npm install watlas && node xatlas.mjs IN.obj OUT.obj [--size 1024] [--padding 4] [--brute-force]
//
// watlas is xatlas compiled to WebAssembly: slower than the machine's own code, by a factor of 1.3 to 2 as a rule. Prints
// one JSON object: seconds of xatlas alone, the best of three, the charts, and the width and height to measure it at.
import { readFileSync, writeFileSync } from 'node:fs';
import * as watlas from 'watlas';

const [input, output, ...options] = process.argv.slice(2);
const option = (name, otherwise) => (options.includes(name) ? Number(options[options.indexOf(name) + 1]) : otherwise);
const size = option('--size', 1024), padding = option('--padding', 4);

const positions = [], indices = [];
for (const line of readFileSync(input, 'utf8').split('\n')) {
  const words = line.trim().split(/\s+/);
  if (words[0] === 'v') positions.push(...words.slice(1, 4).map(Number));
  if (words[0] === 'f') indices.push(...words.slice(1, 4).map((word) => parseInt(word) - 1));
}

await watlas.Initialize();
let best = Infinity, atlas;
for (let run = 0; run < 3; ++run) {
  atlas = new watlas.Atlas();
  atlas.addMesh({
    vertexPositionData: new Float32Array(positions), vertexCount: positions.length / 3, vertexPositionStride: 12,
    indexData: new Uint32Array(indices), indexCount: indices.length,
  });
  const start = performance.now();
  atlas.generate({}, { resolution: size, padding, bruteForce: options.includes('--brute-force') });
  best = Math.min(best, (performance.now() - start) / 1000);
}
const mesh = atlas.getMesh(0);
const triangles = new Uint32Array(mesh.indexCount);
mesh.getIndexArray(triangles);
const lines = [];
for (let i = 0; i < mesh.vertexCount; ++i) {
  const vertex = mesh.getVertex(i);
  lines.push(`v ${positions.slice(3 * vertex.xref, 3 * vertex.xref + 3).join(' ')}`);
  lines.push(`vt ${vertex.uv[0] / atlas.width} ${vertex.uv[1] / atlas.height}`);
}
for (let i = 0; i < triangles.length; i += 3)
  lines.push('f ' + [0, 1, 2].map((k) => `${triangles[i + k] + 1}/${triangles[i + k] + 1}`).join(' '));
writeFileSync(output, lines.join('\n') + '\n');
console.log(JSON.stringify({ seconds: best, charts: atlas.chartCount, width: atlas.width, height: atlas.height }));
