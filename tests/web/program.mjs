// SPDX-License-Identifier: GPL-3.0-or-later
// A program of three.js's own that uses the module, on the rasteriser of kiln-render.
import assert from 'node:assert/strict';
import { after, before } from 'node:test';
import { join } from 'node:path';
import { assets, browse, compare, dist, openPage, pixelsOf, serve, sources, web } from './harness.mjs';

export const size = [192, 160];
const program = `<!doctype html><script type="importmap">{"imports": {"three": "/three/build/three.module.js", "three/addons/": "/three/examples/jsm/"}}</script>
<script type="module">
import * as THREE from 'three';
import { HDRLoader } from 'three/addons/loaders/HDRLoader.js';
import * as kiln from '/dist/kiln.js';
const renderer = new THREE.WebGLRenderer({ antialias: false, alpha: true });
renderer.setSize(${size[0]}, ${size[1]}, false);
renderer.setClearColor(0, 0);
const camera = new THREE.PerspectiveCamera(30, ${size[0] / size[1]});
const loaded = {};
window.load = async (url) => (loaded[url] ??= await new kiln.KilnLoader().loadAsync(url));
window.hdr = await new HDRLoader().loadAsync('/assets/sky.hdr');
window.draw = (asset, prepare, view = {}) => {
  const scene = new THREE.Scene();
  scene.add(asset.mesh);
  asset.mesh.rotation.set(0, 0, 0);
  asset.light.useScene().window = 'hann';
  asset.light.bands = 0;
  const turned = prepare({ asset, scene, light: asset.light, THREE, kiln });
  kiln.fitCamera(camera, asset.mesh, view);
  if (turned) {
    asset.mesh.rotation.set(0, 0, 0);
    asset.mesh.updateMatrixWorld();
    kiln.fitCamera(camera, asset.mesh, view);
    asset.mesh.setRotationFromMatrix(turned);
    camera.applyMatrix4(turned);
    scene.updateMatrixWorld(true);
    camera.updateMatrixWorld(true);
  }
  asset.uploadAll();
  renderer.render(scene, camera);
  const gl = renderer.getContext();
  const pixels = new Uint8Array(4 * ${size[0] * size[1]});
  gl.readPixels(0, 0, ${size[0]}, ${size[1]}, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  if (gl.isContextLost()) throw new Error('the context was lost');
  let text = '';
  for (const value of pixels) text += String.fromCharCode(value);
  return btoa(text);
};
window.renderer = renderer;
window.kiln = kiln;
window.isReady = true;
</script>`;


/** Opens the program before the tests of a file; `folders` are served beside the assets. Returns how to use it. */
export function openProgram(folders = {}) {
  const opened = {};
  let server, browser;
  before(async () => {
    server = await serve({ '/dist/': dist, '/three/': join(web, 'node_modules/three'), '/assets/': assets, '/post/': join(sources, 'examples/post'), '/version1/': join(sources, 'tests/data/version1'), '/viewer/': dist, '/program.html': () => ['text/html', program], ...folders });
    browser = await browse('llvmpipe');
    opened.page = await openPage(browser);
    await opened.page.goto(`${server.address}/program.html`);
    await opened.page.waitForFunction('window.isReady');
  });
  after(async () => {
    await browser?.close();
    server?.close();
  });
  /** Draws in the page: `light` is a function of the page that sets the light. */
  opened.draw = async (address, light, view = {}) =>
    pixelsOf(await opened.page.evaluate(`load(${JSON.stringify(address)}).then((asset) => draw(asset, ${light}, ${JSON.stringify(view)}))`), size);
  /** Opens another page in the same browser. */
  opened.open = async (address, options) => {
    const page = await openPage(browser, options);
    // One sample for each pixel, as kiln-render draws for these tests.
    await page.addInitScript(() => {
      const original = HTMLCanvasElement.prototype.getContext;
      HTMLCanvasElement.prototype.getContext = function (kind, attributes) {
        return original.call(this, kind, { ...attributes, antialias: false });
      };
    });
    await page.goto(server.address + address);
    return page;
  };
  return opened;
}

/** Holds the page's picture against kiln-render's: mean at most 1/255, 99.9 % of pixels at most 3/255. */
export function same(mine, theirs, what, drawn = size) {
  const { mean, large, most, count } = compare(mine, theirs, drawn);
  assert.ok(count > 3000, `${what}: only ${count} pixels to compare`);
  assert.ok(mean <= 1 && large <= 0.001, `${what}: mean difference ${mean.toFixed(3)}, more than 3 in ${(100 * large).toFixed(3)} % of pixels, most ${most}`);
}
