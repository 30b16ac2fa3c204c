// SPDX-License-Identifier: GPL-3.0-or-later
// What is committed as tools/web/dist is what the sources make, byte for byte, and keeps its promises of size and rest.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { gzipSync } from 'node:zlib';
import { dist, sources, temporary, web } from './harness.mjs';

test('the sources make the committed bundle', () => {
  const made = join(temporary, 'dist');
  execFileSync(process.execPath, [join(web, 'build.mjs'), made], { stdio: 'pipe' });
  assert.deepEqual(readdirSync(made).sort(), readdirSync(dist).sort());
  for (const name of readdirSync(made))
    assert.ok(readFileSync(join(made, name)).equals(readFileSync(join(dist, name))), `tools/web/dist/${name} is old; make it anew: tests/web/rebuild.sh`);
});

test('the types are right', () => {
  try {
    execFileSync(process.execPath, [join(web, 'node_modules/typescript/bin/tsc'), '--noEmit', '-p', web], { stdio: 'pipe', encoding: 'utf8' });
  } catch (error) {
    assert.fail(error.stdout);
  }
});

test('the page is at most 400 kB, gzipped', () => {
  const sum = ['index.html', 'kiln-viewer.js', 'kiln-viewer.css'].reduce((total, name) => total + gzipSync(readFileSync(join(dist, name))).length, 0);
  assert.ok(sum <= 400_000, `${sum} bytes`);
});

test('versions are exact, run on Node 18, and name no registry', () => {
  const { dependencies, devDependencies } = JSON.parse(readFileSync(join(sources, 'tools/web/package.json'), 'utf8'));
  for (const [name, version] of Object.entries({ ...dependencies, ...devDependencies })) assert.match(version, /^\d+\.\d+\.\d+$/, `${name} ${version}`);
  const lock = JSON.parse(readFileSync(join(sources, 'tools/web/package-lock.json'), 'utf8'));
  for (const [name, { resolved, engines }] of Object.entries(lock.packages)) {
    assert.equal(resolved, undefined, `${name} names a registry`);
    if (name && engines?.node) assert.match(engines.node, /^\*$|>=\s*(?:[0-9]|1[0-8])(?:\D|$)|\^18/, `${name} wants Node ${engines.node}`);
  }
});
