// SPDX-License-Identifier: GPL-3.0-or-later
// What the bake and the compression write can pass through a browser unchanged: grey, no alpha, nothing about colour.
import assert from 'node:assert/strict';
import { existsSync, readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { assets, sources } from './harness.mjs';

function chunksOf(bytes) {
  const names = [];
  for (let at = 8; at < bytes.length; at += 12 + bytes.readUInt32BE(at)) names.push(bytes.toString('latin1', at + 4, at + 8));
  return names;
}

const folders = [...readdirSync(assets).map((name) => join(assets, name)), join(sources, 'examples/post')].filter((folder) => ['ranges.json', 'pca.json'].some((name) => existsSync(join(folder, name))));

test('pictures of planes, weights, vectors and clusters are plain numbers', () => {
  let count = 0;
  for (const folder of folders)
    for (const name of readdirSync(folder).filter((each) => /^(coeff|weight|vectors|clusters).*\.png$/.test(each))) {
      const bytes = readFileSync(join(folder, name));
      assert.equal(bytes[25], 0, `${folder}/${name} has the colour type ${bytes[25]}, not grey`);
      assert.equal(bytes[28], 0, `${folder}/${name} is interlaced`);
      for (const chunk of ['gAMA', 'sRGB', 'cHRM', 'iCCP', 'tRNS', 'cICP']) assert.ok(!chunksOf(bytes).includes(chunk), `${folder}/${name} has a chunk ${chunk}`);
      ++count;
    }
  assert.ok(count > 100, `only ${count} pictures were found`);
});

test('maps have no alpha and no colour profile either', () => {
  let count = 0;
  for (const folder of folders)
    for (const name of ['normal.png', 'albedo.png'].filter((each) => existsSync(join(folder, each)))) {
      const bytes = readFileSync(join(folder, name));
      assert.equal(bytes[25], 2, `${folder}/${name} is not RGB`);
      for (const chunk of ['gAMA', 'cHRM', 'iCCP', 'tRNS', 'cICP']) assert.ok(!chunksOf(bytes).includes(chunk), `${folder}/${name} has a chunk ${chunk}`);
      ++count;
    }
  assert.ok(count > 5, `only ${count} maps were found`);
});
