// SPDX-License-Identifier: MIT
// build.mjs [OUT]: makes dist/ (or OUT) from src/, the same bytes from the same sources. `npm ci` comes first.
import { copyFileSync, mkdirSync, readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { build, transformWithEsbuild } from 'vite';

const home = dirname(fileURLToPath(import.meta.url));
const out = resolve(process.argv[2] ?? join(home, 'dist'));
mkdirSync(out, { recursive: true });
for (const mode of ['library', 'viewer'])
  await build({ root: home, configFile: join(home, 'vite.config.ts'), mode, logLevel: 'warn', build: { outDir: out } });

// Vite leaves the white space of modules alone; here nobody reads on.
const banner = '// SPDX-License-Identifier: MIT\n// Made by tools/web/build.mjs of Kiln, with parts of others: see THIRD_PARTY.txt.\n';
for (const name of ['kiln.js', 'kiln-viewer.js']) {
  const { code } = await transformWithEsbuild(readFileSync(join(out, name), 'utf8'), name, { minify: true, target: 'es2022', legalComments: 'none', sourcemap: false });
  writeFileSync(join(out, name), banner + code);
}
writeFileSync(join(out, 'kiln-viewer.css'), `/* SPDX-License-Identifier: MIT */\n${readFileSync(join(out, 'kiln-viewer.css'), 'utf8')}`);
copyFileSync(join(home, 'index.html'), join(out, 'index.html'));

const parts = ['three', 'fast-png', 'fflate', 'iobuffer'].map((name) => {
  const folder = join(home, 'node_modules', name);
  const { version } = JSON.parse(readFileSync(join(folder, 'package.json'), 'utf8'));
  const file = readdirSync(folder).find((entry) => /^licen[cs]e/i.test(entry));
  return `${name} ${version}\n\n${readFileSync(join(folder, file), 'utf8').trim()}\n`;
});
parts.push('Draco decoder (of three.js), Copyright the Draco Authors, Apache License 2.0: https://www.apache.org/licenses/LICENSE-2.0\n');
parts.push('meshoptimizer decoder (of three.js), Copyright (c) 2016-2025 Arseny Kapoulkine, MIT licence\n');
parts.push('MikkTSpace (of three.js), Copyright (C) 2011 by Morten S. Mikkelsen, zlib licence\n');
writeFileSync(join(out, 'THIRD_PARTY.txt'), `kiln.js and kiln-viewer.js hold parts of:\n\n${parts.join(`\n${'-'.repeat(72)}\n\n`)}`);
