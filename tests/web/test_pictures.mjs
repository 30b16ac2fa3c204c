// SPDX-License-Identifier: GPL-3.0-or-later
// The module in a program of three.js's own: the same pictures as kiln-render's.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { join } from 'node:path';
import { assets, compare, pixelsOf, render, renderEach, sources, spread } from './harness.mjs';
import { openProgram, same, size } from './program.mjs';

const program = openProgram();
const { draw } = program;

test('it draws on llvmpipe', async () => {
  const name = await program.page.evaluate("(() => { const gl = renderer.getContext(); return gl.getParameter(gl.getExtension('WEBGL_debug_renderer_info').UNMASKED_RENDERER_WEBGL); })()");
  assert.match(name, /llvmpipe/);
});

for (const form of ['plain', 'deep', 'tangent', 'coloured', 'coloured_deep', 'vertices', 'vertices_deep', 'compressed', 'clustered', 'clustered_coloured'])
  test(`the form ${form} looks as kiln-render draws it, and follows the light as there`, async () => {
    const places = [[45, 30], [-70, 15]];
    const theirs = await renderEach(join(assets, form), size, places.map((place) => `${place},1,0.8,0.6`));
    const mine = [];
    for (const [k, [azimuth, elevation]] of places.entries()) {
      const address = `/assets/${form}/${/^(compressed|clustered)/.test(form) ? 'pca.json' : ''}`;
      mine.push(await draw(address, `({ light }) => void light.setDirectional(${azimuth}, ${elevation}, [1, 0.8, 0.6])`));
      same(mine[k], theirs[k], `${form}, light ${azimuth},${elevation}`);
      assert.ok(spread(mine[k]).deviation > 8, `${form} is drawn in one shade`);
    }
    const [moved, wanted] = [compare(mine[0], mine[1], size).mean, compare(theirs[0], theirs[1], size).mean];
    assert.ok(wanted > 10 && Math.abs(moved - wanted) < 1, `${form}: the light changed the picture by ${moved}, kiln-render's by ${wanted}`);
  });

test('an asset of version 1 with albedo, and one of 5 bands', async () => {
  for (const folder of ['textured', 'pca', 'vertices'])
    same(await draw(`/version1/${folder}/${folder === 'pca' ? 'pca.json' : 'ranges.json'}`, '({ light }) => void light.setDirectional(20, 50)'), await render(join(sources, 'tests/data/version1', folder), size, ['--light', '20,50']), folder);
  same(await draw('/post', '({ light }) => void light.setDirectional(20, 50)', { azimuth: -40, elevation: 35 }), await render(join(sources, 'examples/post'), size, ['--light', '20,50', '--camera', '-40,35']), 'post');
});

const lights = {
  'a cone and a hemisphere': ['({ light }) => void light.clear().addCone(-60, 50, 40, [1, 0.6, 0.3]).addHemisphere([0.1, 0.2, 0.4], [0.1, 0.05, 0])', '--light', 'cone:-60,50,40,1,0.6,0.3', '--light', 'hemisphere:0,90,0.1,0.2,0.4,0.1,0.05,0'],
  'the window dering': ["({ light }) => { light.window = 'dering'; light.setDirectional(45, 30); }", '--light', '45,30', '--window', 'dering'],
  'the window lanczos': ["({ light }) => { light.window = 'lanczos'; light.setDirectional(45, 30); }", '--light', '45,30', '--window', 'lanczos'],
  'no window': ["({ light }) => { light.window = 'none'; light.setDirectional(45, 30); }", '--light', '45,30', '--window', 'none'],
  'an environment that is turned': ['({ light }) => void light.setEnvironment(hdr, 40)', '--environment', join(assets, 'sky.hdr'), '--environment-rotation', '40'],
  'an environment under dering': ["({ light }) => { light.window = 'dering'; light.setEnvironment(hdr); }", '--environment', join(assets, 'sky.hdr'), '--window', 'dering'],
  "three.js's own lights": ['({ scene, THREE }) => { const sun = new THREE.DirectionalLight(0xffffff, 0.7 * Math.PI); sun.position.set(0, 3, 4); scene.add(sun, new THREE.AmbientLight(0xffffff, 0.2 * Math.PI)); }', '--light', '0,36.8698976,0.7,0.7,0.7', '--ambient', '0.2'],
  "three.js's LightProbe": ['({ scene, THREE }) => { const sh = new THREE.SphericalHarmonics3(); const [mean, slope] = [0.5 * Math.sqrt(4 * Math.PI), 0.3 * Math.sqrt(4 * Math.PI / 3)]; sh.coefficients[0].setScalar(mean); sh.coefficients[1].setScalar(slope); scene.add(new THREE.LightProbe(sh, 2)); }', '--light', 'hemisphere:0,90,1.6,1.6,1.6,0.4,0.4,0.4'],
  "three.js's environment": ['({ scene }) => { scene.environment = hdr; hdr.mapping = 303; }', '--environment', join(assets, 'sky.hdr')],
};
for (const [name, [light, ...options]] of Object.entries(lights))
  test(`light: ${name}`, async () => {
    same(await draw('/assets/plain', light), await render(join(assets, 'plain'), size, options), name);
  });

test('a mesh that is turned turns its light the other way', async () => {
  const still = await draw('/assets/coloured', '({ light }) => void light.setDirectional(45, 30)');
  const turned = await draw('/assets/coloured', `({ light, THREE, kiln }) => {
    const turn = new THREE.Matrix4().makeRotationFromEuler(new THREE.Euler(0.7, -1.9, 0.4));
    const d = new THREE.Vector3(...kiln.directionOf(45, 30)).transformDirection(turn);
    light.clear().add({ kind: 'directional', direction: d.toArray(), radiance: [1, 1, 1] });
    return turn;
  }`);
  assert.ok(compare(still, turned, size).mean < 0.3, 'the picture changes when everything turns together');
});

test('fewer bands of light are fewer bands', async () => {
  const two = await draw('/assets/plain', '({ light }) => { light.bands = 2; light.setDirectional(45, 30); }');
  const coefficients = await program.page.evaluate("load('/assets/plain').then((asset) => { const light = new kiln.KilnLight().setDirectional(45, 30); light.bands = 2; return Array.from(light.coefficients(4)[0]); })");
  assert.equal(coefficients.length, 16);
  assert.ok(coefficients.slice(4).every((value) => value === 0) && coefficients.slice(0, 4).every((value) => value !== 0));
  assert.ok(compare(two, await draw('/assets/plain', '({ light }) => void light.setDirectional(45, 30)'), size).mean > 1);
});

test('harmonics: closed forms, rotation, and the worked light of docs/format.md', async () => {
  const { basis, turned, direct, light } = await program.page.evaluate(`(() => {
    const d = [0.36, -0.48, 0.8], r = [0.36, 0.48, -0.8, -0.8, 0.6, 0, 0.48, 0.64, 0.6];
    const rd = [0, 1, 2].map((k) => r[3 * k] * d[0] + r[3 * k + 1] * d[1] + r[3 * k + 2] * d[2]);
    return { basis: [...kiln.evaluateBasis(5, ...d)], turned: [...new kiln.HarmonicRotation(8, r).apply(kiln.evaluateBasis(8, ...d))], direct: [...kiln.evaluateBasis(8, ...rd)],
      light: [...new kiln.KilnLight().setDirectional(45, 30).coefficients(5)[0]] };
  })()`);
  const [x, y, z] = [0.36, -0.48, 0.8];
  for (const [i, value] of [[0, 0.282095], [1, 0.488603 * y], [7, 1.092548 * x * z], [12, 0.373176 * z * (5 * z * z - 3)], [16, 2.503343 * x * y * (x * x - y * y)], [20, 0.105786 * (35 * z ** 4 - 30 * z * z + 3)], [24, 0.625836 * (x ** 4 - 6 * x * x * y * y + y ** 4)]])
    assert.ok(Math.abs(basis[i] - value) < 2e-6, `B_${i} is ${basis[i]}, not ${value}`);
  turned.forEach((value, i) => assert.ok(Math.abs(value - direct[i]) < 1e-9, `rotation of B_${i}`));
  for (const [i, value] of [0.98707, 0.773199, 0.946972].entries()) assert.ok(Math.abs(light[i] - value) < 1e-5, `L_${i} is ${light[i]}, not ${value}`);
});

/** Draws an asset in the viewer page, in one sample for each pixel; without the fill light. */
async function drawInViewer(folder, technique) {
  const page = await program.open(`/viewer/?asset=/assets/${folder}`, { viewport: { width: 800, height: 240 } });
  const { text, drawn } = await page.evaluate(`import('/viewer/kiln-viewer.js').then(async ({ viewer, fitCamera }) => {
    await viewer.opened;
    const { stage } = viewer;
    viewer.store.set({ azimuth: 45, elevation: 30, fill: 0, technique: '${technique}' });
    if ('${technique}' !== 'transfer') await stage.shown[0].plain.show('${technique}');
    fitCamera(stage.camera, stage.shown[0].asset.mesh);
    stage.shown[0].asset.uploadAll();
    stage.render();
    const gl = stage.renderer.getContext(), drawn = [gl.drawingBufferWidth, gl.drawingBufferHeight];
    const pixels = new Uint8Array(4 * drawn[0] * drawn[1]);
    gl.readPixels(0, 0, ...drawn, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    let text = '';
    for (let i = 0; i < pixels.length; i += 8192) text += String.fromCharCode(...pixels.subarray(i, i + 8192));
    return { text: btoa(text), drawn };
  })`);
  assert.deepEqual([page.said, page.elsewhere], [[], []]);
  await page.context().close();
  return { mine: pixelsOf(text, drawn), drawn };
}

for (const [technique, name] of [['transfer', 'textured-prt'], ['phong', 'phong']])
  test(`the viewer page draws by ${name} as kiln-render does`, async () => {
    const { mine, drawn } = await drawInViewer('coloured', technique);
    same(mine, await render(join(assets, 'coloured'), drawn, ['--light', '45,30', '--technique', name]), name, drawn);
  });

// Browsers cut these maps to 8 bits, and kiln-render turns tangent space into object space for each texel before it
// blends; a bitangent of the wrong sign differs by 60.
for (const folder of ['coloured', 'hard'])
  test(`the viewer page draws the normal map of ${folder} nearly as kiln-render does`, async () => {
    const { mine, drawn } = await drawInViewer(folder, 'normal-map');
    const { mean, count } = compare(mine, await render(join(assets, folder), drawn, ['--light', '45,30', '--technique', 'normal-map']), drawn);
    assert.ok(count > 3000 && mean <= 2, `${folder}: mean difference ${mean}`);
  });

test('nothing left the origin, and nothing complained', () => {
  assert.deepEqual(program.page.elsewhere, []);
  assert.deepEqual(program.page.said, []);
});
