// SPDX-License-Identifier: GPL-3.0-or-later
// What `kiln export` writes is relit like the folder it was made of.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { assets, programs, render, temporary } from './harness.mjs';
import { openProgram, same, size } from './program.mjs';

const program = openProgram({ '/glb/': temporary });

function exported(name, folder, ...options) {
  execFileSync(join(programs, 'kiln-export'), [join(assets, folder), '-o', join(temporary, `${name}.glb`), '--quiet', ...options]);
  return `/glb/${name}.glb`;
}

for (const [name, folder, ...options] of [
  ['plain', 'plain'], ['meshopt', 'plain', '--meshopt'], ['uncompressed', 'plain', '--uncompressed'], ['deep', 'deep'], ['tangent', 'tangent'],
  ['coloured', 'coloured'], ['clustered', 'clustered'], ['clustered_coloured', 'clustered_coloured'], ['vertices', 'vertices'], ['vertices_deep', 'vertices_deep'],
])
  test(`${name}.glb looks as kiln-render draws the folder`, async () => {
    const address = exported(name, folder, ...options);
    same(await program.draw(address, '({ light }) => void light.setDirectional(45, 30, [1, 0.8, 0.6])'), await render(join(assets, folder), size, ['--light', '45,30,1,0.8,0.6']), name);
  });

test('a glTF without the extension, and one cut short, are refused with a message', async () => {
  exported('whole', 'plain');
  const bytes = readFileSync(join(temporary, 'whole.glb'));
  writeFileSync(join(temporary, 'short.glb'), bytes.subarray(0, bytes.length - 100));
  writeFileSync(join(temporary, 'other.glb'), Buffer.from(bytes.toString('latin1').replaceAll('KILN_prt', 'NOTA_prt'), 'latin1'));
  const refusal = (name) => program.page.evaluate(`new kiln.KilnLoader().loadAsync('/glb/${name}.glb').then(() => 'loaded', (error) => error.name + ': ' + error.message)`);
  assert.match(await refusal('short'), /^KilnError: .*short\.glb: found a file that ends early/);
  assert.match(await refusal('other'), /^KilnError: .*other\.glb: found no extension KILN_prt/);
});

test('nothing left the origin, and nothing complained', () => {
  assert.deepEqual(program.page.elsewhere, []);
  assert.deepEqual(program.page.said, []);
});
