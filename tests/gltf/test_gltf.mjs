// SPDX-License-Identifier: GPL-3.0-or-later
// Kiln's glTF files in other people's hands: test_gltf.mjs PROGRAMS SOURCES, from a folder with the packages.
//
// Assets of every form are made and exported in all forms of the mesh. Of each file: gltf-validator finds neither error
// nor warning; glTF-Transform reads it, with Draco's and meshoptimizer's decoders, and the mesh is that of the
// uncompressed file; written again with our extension, planes and manifest are the same bytes; gltfpack -ke keeps the
// way to the manifest.
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { createRequire } from 'node:module';
import { NodeIO, Logger } from '@gltf-transform/core';
import { ALL_EXTENSIONS } from '@gltf-transform/extensions';
import draco3d from 'draco3dgltf';
import validator from 'gltf-validator';
import { MeshoptDecoder, MeshoptEncoder } from 'meshoptimizer';
import { KilnPrt } from './kiln-prt.mjs';

const [programs, sources] = process.argv.slice(2).map((folder) => path.resolve(folder));
const gltfpack = createRequire(import.meta.url).resolve('gltfpack/cli.js');
const folder = fs.mkdtempSync(path.join(os.tmpdir(), 'kiln-gltf-'));
process.on('exit', () => fs.rmSync(folder, { recursive: true, force: true }));
process.chdir(folder);

let faults = 0;
function fault(text) {
  console.error(`FAULT: ${text}`);
  faults += 1;
}
function same(found, expected, what) {
  if (JSON.stringify(found) !== JSON.stringify(expected))
    fault(`${what}: found ${JSON.stringify(found)?.slice(0, 200)}; expected ${JSON.stringify(expected)?.slice(0, 200)}`);
}
function run(program, ...words) {
  execFileSync(path.join(programs, program), [...words, '--quiet'], { stdio: ['ignore', 'ignore', 'inherit'] });
}

// Assets: planes of 8 and 16 bits, normals in both spaces, of one and three channels, an opacity, compressed planes,
// vertices, an origin far away.
const post = path.join(sources, 'examples', 'post.obj');
const quick = ['--bands', '2', '--directions', '64', '--backend', 'embree'];
fs.cpSync(path.join(sources, 'examples', 'post'), 'post', { recursive: true });
run('kiln-atlas', post, '-o', 'atlas.drc', '--size', '32', '--gutter', '2');
run('kiln-normals', post, 'atlas.drc', '-o', 'tangent', '--space', 'tangent');
run('kiln-bake', 'atlas.drc', '--detail', 'tangent', '--occluder', post, '-o', 'wide', '--bits', '16', ...quick);
run('kiln-normals', post, 'atlas.drc', '-o', 'red', '--albedo', '0.8,0.3,0.2');
run('kiln-bake', 'atlas.drc', '--detail', 'red', '--occluder', post, '-o', 'bounces', '--bounces', '1', '--albedo', '0.8,0.3,0.2', ...quick);
run('kiln-compress', 'post', '-o', 'pca', '--clusters', '2', '--pca', '3');
run('kiln-bake', post, '--per-vertex', '-o', 'vertices', ...quick);
const far = fs.readFileSync(post, 'utf8').replace(/^v (\S+) (\S+) (\S+)/gm, (_, x, y, z) => `v ${(Number(x) + 4000000).toFixed(6)} ${Number(y).toFixed(6)} ${Number(z).toFixed(6)}`);
fs.writeFileSync('far.obj', far);
run('kiln-atlas', 'far.obj', '-o', 'far/atlas.drc', '--size', '32', '--gutter', '2');
run('kiln-bake', 'far/atlas.drc', '--receiver', 'low', '-o', 'away', ...quick);
// A card whose opacity is a picture: a plane of the example serves, which has light and dark texels.
fs.writeFileSync('card.obj', 'v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n');
run('kiln-atlas', 'card.obj', '-o', 'card/atlas.drc', '--size', '32', '--gutter', '2');
run('kiln-normals', 'card.obj', 'card/atlas.drc', '-o', 'card/normals', '--opacity-texture', path.join(sources, 'examples/post/coeff_0_01.png'));
run('kiln-bake', 'card/atlas.drc', '--detail', 'card/normals', '--occluder', 'card.obj', '-o', 'leaf', ...quick);
const assets = ['post', 'wide', 'bounces', 'pca', 'vertices', 'away', 'leaf'];

const io = new NodeIO()
  .setLogger(new Logger(Logger.Verbosity?.WARN ?? 2))
  .registerExtensions([...ALL_EXTENSIONS, KilnPrt])
  .registerDependencies({
    'draco3d.decoder': await draco3d.createDecoderModule(),
    'draco3d.encoder': await draco3d.createEncoderModule(),
    'meshopt.decoder': MeshoptDecoder,
    'meshopt.encoder': MeshoptEncoder,
  });

/** Returns the JSON of a glb, and the bytes of its buffer. */
function partsOf(file) {
  const bytes = fs.readFileSync(file);
  const length = bytes.readUInt32LE(12);
  return { json: JSON.parse(bytes.subarray(20, 20 + length).toString('utf8')), buffer: bytes.subarray(28 + length) };
}

async function validate(file) {
  const { issues } = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)), { uri: file, maxIssues: 0 });
  for (const issue of issues.messages) if (issue.severity < 2) fault(`${file}: ${issue.code} at ${issue.pointer}: ${issue.message}`);
}

/** Holds the extension of a file, as its bytes have it, against the asset's folder. */
function checkPrt(file, asset) {
  const { json, buffer } = partsOf(file);
  const { manifest, pictures, attributes } = json.materials[0].extensions.KILN_prt;
  const name = ['pca.json', 'ranges.json'].find((one) => fs.existsSync(path.join(asset, one)));
  same(manifest, JSON.parse(fs.readFileSync(path.join(asset, name), 'utf8')), `${file}: manifest`);
  same(json.extensionsUsed.includes('KILN_prt'), true, `${file}: extensionsUsed`);
  same(json.extensionsRequired?.includes('KILN_prt') ?? false, false, `${file}: extensionsRequired`);
  const files = manifest.planes.flatMap((plane) => plane.file ?? []);
  if (manifest.vectors_file) files.push(manifest.vectors_file);
  if (manifest.cluster_ids) files.push(manifest.cluster_ids);
  same(Object.keys(pictures ?? {}).sort(), files.sort(), `${file}: names of pictures`);
  for (const [picture, { index }] of Object.entries(pictures ?? {})) {
    const view = json.bufferViews[json.images[json.textures[index].source].bufferView];
    const bytes = buffer.subarray(view.byteOffset, view.byteOffset + view.byteLength);
    if (!bytes.equals(fs.readFileSync(path.join(asset, picture)))) fault(`${file}: the bytes of ${picture} have changed`);
  }
  const named = json.meshes[0].primitives[0].attributes;
  for (const attribute of Object.values(attributes ?? {})) if (!(attribute in named)) fault(`${file}: no attribute ${attribute}`);
  same(Boolean(attributes), manifest.vertices > 0, `${file}: attributes`);
}

/** Returns the values of all attributes, a row for each corner of each triangle, in an order of their own. */
function cornersOf(document) {
  const [primitive] = document.getRoot().listMeshes()[0].listPrimitives();
  const names = primitive.listSemantics().sort();
  const indices = primitive.getIndices();
  const rows = [];
  for (let k = 0; k < indices.getCount(); ++k)
    rows.push(names.map((name) => primitive.getAttribute(name).getElement(indices.getScalar(k), [])));
  return { names, rows };
}

/** Holds the mesh of a file against that of the uncompressed one: every triangle's corners, whatever their order. */
function checkMesh(file, document, plain) {
  const { json } = partsOf(file);
  const [primitive] = document.getRoot().listMeshes()[0].listPrimitives();
  // Accessors say what decoders yield.
  for (const [name, index] of Object.entries(json.meshes[0].primitives[0].attributes)) {
    const accessor = json.accessors[index], decoded = primitive.getAttribute(name);
    same(decoded.getCount(), accessor.count, `${file}: count of ${name}`);
    if (name !== 'POSITION') continue;
    same([decoded.getMinNormalized([]), decoded.getMaxNormalized([])], [accessor.min, accessor.max], `${file}: box`);
  }
  same(primitive.getIndices().getCount(), json.accessors[json.meshes[0].primitives[0].indices].count, `${file}: indices`);
  const found = cornersOf(document), expected = cornersOf(plain);
  same(found.names, expected.names, `${file}: attributes`);
  same(found.rows.length, expected.rows.length, `${file}: corners`);
  const exact = !json.extensionsUsed.includes('KHR_draco_mesh_compression');
  // Draco: steps of 1/65,535 of the box (of 4 units at most here) and of the unit square; normals by 12 bits.
  const tolerance = { POSITION: 4 / 65535, TEXCOORD_0: 1 / 65535, TEXCOORD_1: 1 / 65535, NORMAL: 2e-3, TANGENT: 0 };
  const fits = (row, other) =>
    row.every((values, a) => values.every((value, k) => Math.abs(value - other[a][k]) <= (exact ? 0 : (tolerance[found.names[a]] ?? 0))));
  const left = [...expected.rows];
  for (const row of found.rows) {
    const at = left.findIndex((other) => fits(row, other));
    if (at < 0) return fault(`${file}: a corner that the uncompressed file has not: ${JSON.stringify(row).slice(0, 300)}`);
    left.splice(at, 1);
  }
}

for (const asset of assets) {
  const plainFile = `${asset}_plain.glb`;
  run('kiln-export', asset, '-o', plainFile, '--uncompressed');
  const plain = await io.read(plainFile);
  for (const [form, words] of [['plain', ['--uncompressed']], ['draco', []], ['meshopt', ['--meshopt']]]) {
    const file = `${asset}_${form}.glb`;
    if (form !== 'plain') run('kiln-export', asset, '-o', file, ...words);
    await validate(file);
    checkPrt(file, asset);
    const document = await io.read(file);
    checkMesh(file, document, plain);

    // Through glTF-Transform and back: with the extension's module the same planes, without it the way to them.
    const again = `again_${file}`;
    await io.write(again, document);
    await validate(again);
    checkPrt(again, asset);
    same(partsOf(again).json.materials[0].extras.kiln, partsOf(file).json.materials[0].extras.kiln, `${again}: extras`);
  }
  const bare = await new NodeIO().setLogger(new Logger(4)).read(plainFile);
  await new NodeIO().write(`bare_${asset}.glb`, bare);
  const packed = `packed_${asset}.glb`;
  execFileSync(process.execPath, [gltfpack, '-ke', '-i', plainFile, '-o', packed], { stdio: ['ignore', 'ignore', 'inherit'] });
  for (const file of [`bare_${asset}.glb`, packed]) {
    const [material] = partsOf(file).json.materials;
    same(material.extensions?.KILN_prt, undefined, `${file}: extension of a tool that does not know it`);
    const manifest = path.join(folder, material.extras?.kiln ?? 'nowhere');
    if (!fs.existsSync(manifest)) fault(`${file}: extras.kiln leads to ${material.extras?.kiln}`);
  }
}

// The far asset stands at its place.
same(partsOf('away_draco.glb').json.nodes[0].translation?.[0] > 3e6, true, 'away: translation');
// Tangents are unit vectors of sign 1 or -1, also through Draco.
const tangents = (await io.read('wide_draco.glb')).getRoot().listMeshes()[0].listPrimitives()[0].getAttribute('TANGENT');
for (let k = 0; k < tangents.getCount(); ++k) {
  const [x, y, z, sign] = tangents.getElement(k, []);
  if (Math.abs(sign) !== 1 || Math.abs(Math.hypot(x, y, z) - 1) > 1e-5) fault(`tangent ${k} is ${[x, y, z, sign]}`);
}

console.log(faults === 0 ? `${assets.length} assets pass through other people's hands` : `${faults} faults`);
process.exitCode = faults === 0 ? 0 : 1;
