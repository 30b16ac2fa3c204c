// SPDX-License-Identifier: GPL-3.0-or-later
// The viewer page and <kiln-asset>, as people use them: pointer, fingers, keys, broken assets.
import assert from 'node:assert/strict';
import { cpSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { encode } from 'fast-png';
import { assets, browse, compare, dist, openPage, pixelsOf, serve, spread, temporary, until } from './harness.mjs';

const site = join(temporary, 'site');
const broken = join(temporary, 'broken');
let server, browser, page;

/** Makes a copy of the plain asset with one thing wrong. */
function breakOne(name, change) {
  const folder = join(broken, name);
  cpSync(join(assets, 'plain'), folder, { recursive: true });
  change(folder);
}

/** Changes the JSON of such a copy. */
function edit(change) {
  return (folder) => {
    const file = join(folder, 'ranges.json');
    const json = JSON.parse(readFileSync(file, 'utf8'));
    change(json);
    writeFileSync(file, JSON.stringify(json));
  };
}

const faults = {
  'cut short': [(folder) => writeFileSync(join(folder, 'coeff_0_03.png'), readFileSync(join(folder, 'coeff_0_03.png')).subarray(0, 200)), /coeff_0_03\.png: found no sound PNG: it ends early/],
  'changed byte': [(folder) => { const bytes = readFileSync(join(folder, 'coeff_0_05.png')); bytes[60] ^= 1; writeFileSync(join(folder, 'coeff_0_05.png'), bytes); }, /coeff_0_05\.png: found no sound PNG: the checksum/],
  'other size': [(folder) => writeFileSync(join(folder, 'coeff_0_04.png'), encode({ width: 16, height: 16, channels: 1, depth: 8, data: new Uint8Array(256) })), /coeff_0_04\.png: found 16 x 16 texels; expected 32 x 32/],
  colours: [(folder) => writeFileSync(join(folder, 'coeff_0_04.png'), encode({ width: 32, height: 32, channels: 3, depth: 8, data: new Uint8Array(3072) })), /coeff_0_04\.png: found colours or alpha/],
  'other bits': [edit((json) => { json.bits = 16; }), /found 8 bits; expected 16 bits/],
  'lost plane': [edit((json) => { json.planes[4].file = 'nowhere.png'; }), /nowhere\.png: found status 404/],
  'lost entry': [edit((json) => { json.planes.pop(); }), /found 15 planes; expected 16/],
  'bad mesh': [(folder) => writeFileSync(join(folder, 'atlas.drc'), readFileSync(join(folder, 'atlas.drc')).subarray(0, 90)), /atlas\.drc: found a mesh that cannot be decoded/],
  'no mesh': [(folder) => writeFileSync(join(folder, 'atlas.drc'), 'not a mesh at all'), /atlas\.drc: found no Draco mesh/],
  'unknown requires': [edit((json) => { json.requires = ['hologram']; }), /"requires" names hologram, which this reader does not know/],
  'new version': [edit((json) => { json.version = 9; }), /found version 9/],
  'no JSON': [(folder) => writeFileSync(join(folder, 'ranges.json'), '{"format": "kiln'), /ranges\.json: found no JSON/],
  'way out': [edit((json) => { json.mesh = '../plain/atlas.drc'; }), /expected a path inside the folder/],
  spectral: [edit((json) => { json.channels = 5; }), /found 5 channels, a spectral asset/],
};

before(async () => {
  cpSync(dist, site, { recursive: true });
  for (const name of ['plain', 'coloured', 'clustered', 'vertices']) cpSync(join(assets, name), join(site, 'assets', name), { recursive: true });
  writeFileSync(join(site, 'assets.json'), JSON.stringify({ assets: [{ name: 'plain post', path: 'assets/plain' }, { name: 'coloured', path: 'assets/coloured' }, { name: 'vertices', path: 'assets/vertices' }] }));
  mkdirSync(broken);
  for (const [name, [change]] of Object.entries(faults)) breakOne(name, change);
  server = await serve({ '/deep/below/': site, '/bare/': dist, '/broken/': broken, '/large/': large(), '/element.html': () => ['text/html', '<!doctype html><script type="module" src="/bare/kiln-viewer.js"></script><kiln-asset id="a" src="/deep/below/assets/coloured" light="-60,40" style="width: 200px; height: 150px"></kiln-asset><kiln-asset id="b" src="/broken/spectral"></kiln-asset>'] });
  browser = await browse('swiftshader');
  page = await openPage(browser, { viewport: { width: 800, height: 420 } });
  await open(page, '/deep/below/');
});
after(async () => {
  await browser?.close();
  server?.close();
});

/** Makes an asset of 7 layers of 1 MB. */
function large() {
  const folder = join(temporary, 'large');
  mkdirSync(folder);
  const side = 512;
  const json = JSON.parse(readFileSync(join(assets, 'plain', 'ranges.json'), 'utf8'));
  const png = encode({ width: side, height: side, channels: 1, depth: 8, data: Uint8Array.from({ length: side * side }, (_, i) => i >> 3) });
  Object.assign(json, { bands: 5, width: side, height: side, planes: Array.from({ length: 25 }, (_, i) => ({ file: 'plane.png', channel: 0, coefficient: i, min: 0, max: 0.2 })) });
  writeFileSync(join(folder, 'ranges.json'), JSON.stringify(json));
  writeFileSync(join(folder, 'plane.png'), png);
  cpSync(join(assets, 'plain', 'atlas.drc'), join(folder, 'atlas.drc'));
  return folder;
}

async function open(where, path) {
  await where.goto(`${server.address}${path}`);
  await where.evaluate("import(new URL('kiln-viewer.js', document.baseURI)).then((kiln) => { window.kiln = kiln; window.viewer = kiln.viewer; return viewer?.opened; })");
}

/** Returns the picture as it is now. */
async function shot(where) {
  const { text, size } = await where.evaluate(`(() => {
    const { renderer } = viewer.stage;
    for (const { asset } of viewer.stage.shown) asset.uploadAll();
    viewer.stage.render();
    const gl = renderer.getContext();
    if (gl.isContextLost()) throw new Error('the context was lost');
    const size = [gl.drawingBufferWidth, gl.drawingBufferHeight];
    const pixels = new Uint8Array(4 * size[0] * size[1]);
    gl.readPixels(0, 0, ...size, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    let text = '';
    for (let i = 0; i < pixels.length; i += 8192) text += String.fromCharCode(...pixels.subarray(i, i + 8192));
    return { text: btoa(text), size };
  })()`);
  return { data: pixelsOf(text, size), size };
}

const changed = (a, b) => compare(a.data, b.data, a.size).mean;
const set = (where, state) => where.evaluate(`viewer.store.set(${JSON.stringify(state)})`);

test('the page opens the first asset of its list, below any path', async () => {
  const { count, deviation } = spread((await shot(page)).data);
  assert.ok(count > 5000 && deviation > 8, `${count} pixels, deviation ${deviation}`);
  assert.equal(await page.title(), 'plain post · Kiln');
  assert.match(await page.innerText('.readout'), /Triangles\s*24/);
  assert.deepEqual(page.said, []);
});

test('controls change the picture', async () => {
  const start = await shot(page);
  for (const state of [{ azimuth: 60 }, { light: 'soft', softness: 60 }, { light: 'sky' }, { light: 'even' }, { environment: 'sunset', light: 'none' }, { window: 'none' }, { bands: 2 }, { exposure: 1 }, { technique: 'phong' }, { technique: 'normal-map' }, { show: 'charts' }, { show: 'normals' }, { show: 'coefficient', coefficient: 3 }, { color: '#ff8040' }, { wireframe: true }]) {
    await set(page, state);
    if (state.technique || state.show) await page.evaluate('new Promise((resolve) => setTimeout(resolve, 150))');
    const difference = changed(start, await shot(page));
    assert.ok(difference > 0.4, `${JSON.stringify(state)} changes the picture by ${difference} only`);
    await page.click('button:text-is("Reset")');
  }
  assert.ok(changed(start, await shot(page)) < 0.01, 'Reset does not bring the picture back');
});

test('keys alone reach every control, with a focus that is seen', async () => {
  await page.evaluate('document.activeElement.blur()');
  const wanted = await page.evaluate(`(() => {
    const visible = [...document.querySelectorAll('canvas, a[href], button, input, select, [tabindex="0"]')].filter((each) => each.checkVisibility() && !each.disabled);
    visible.forEach((each, k) => (each.dataset.place = each.type === 'radio' ? each.name : k));
    return [...new Set(visible.map((each) => each.dataset.place))];
  })()`);
  const reached = new Set();
  for (let k = 0; k < wanted.length + 3; ++k) {
    await page.keyboard.press('Tab');
    const { place, outline } = await page.evaluate(`(() => {
      const at = document.activeElement;
      const seen = (each) => each && getComputedStyle(each).outlineStyle !== 'none' && parseFloat(getComputedStyle(each).outlineWidth) >= 1;
      return { place: at.dataset.place, outline: at === document.body || seen(at) || seen(at.nextElementSibling) || seen(at.querySelector('.grip')) };
    })()`);
    if (place !== undefined) reached.add(place);
    assert.ok(outline, `the focus on ${place} is not seen`);
  }
  assert.deepEqual(wanted.filter((place) => !reached.has(place)), []);
});

test('keys turn the view and the light, zoom, and switch what is shown', async () => {
  await page.focus('canvas');
  for (const key of ['ArrowRight', 'Shift+ArrowLeft', '+', 'c', 'n', '.', 'p', 'w', 'w', 'd']) {
    const before = await shot(page);
    for (let k = 0; k < (key.length > 3 ? 6 : 1); ++k) await page.keyboard.press(key);
    await page.evaluate('new Promise((resolve) => setTimeout(resolve, 120))');
    assert.ok(changed(before, await shot(page)) > 0.2, `${key} does nothing`);
  }
  // The line of the comparison.
  await page.focus('.divider');
  const before = await shot(page);
  for (let k = 0; k < 3; ++k) await page.keyboard.press('PageDown');
  assert.equal(await page.getAttribute('.divider', 'aria-valuenow'), '20');
  assert.ok(changed(before, await shot(page)) > 0.2);
  await page.focus('canvas');
  await page.keyboard.press('r');
});

test('shift and drag moves the light, a drag the view', async () => {
  const box = await (await page.$('canvas')).boundingBox();
  const drag = async () => {
    await page.mouse.move(box.x + 200, box.y + 200);
    await page.mouse.down();
    await page.mouse.move(box.x + 280, box.y + 170, { steps: 4 });
    await page.mouse.up();
    return page.evaluate('({ azimuth: viewer.store.state.azimuth, elevation: viewer.store.state.elevation, eye: viewer.stage.camera.position.toArray() })');
  };
  const first = await page.evaluate('viewer.stage.camera.position.toArray()');
  await page.keyboard.down('Shift');
  const lit = await drag();
  await page.keyboard.up('Shift');
  assert.deepEqual([lit.azimuth, lit.elevation, lit.eye], [-5, 50, first]);
  const seen = await drag();
  assert.ok(Math.hypot(...seen.eye.map((v, k) => v - first[k])) > 0.1);
  assert.deepEqual([seen.azimuth, seen.elevation], [-5, 50]);
});

test('several assets stand side by side', async () => {
  await page.click('button:text-is("Reset")');
  for (const name of ['coloured', 'vertices']) await page.check(`input[aria-label="Show ${name} beside the others"]`);
  await until(page, 'viewer.stage.shown.length === 3');
  const places = await page.evaluate('viewer.stage.shown.map(({ asset }) => [asset.mesh.position.x + asset.mesh.geometry.boundingBox.min.x, asset.mesh.position.x + asset.mesh.geometry.boundingBox.max.x])');
  assert.ok(places.every(([low], k) => k === 0 || low > places[k - 1][1]), JSON.stringify(places));
  assert.equal(await page.innerText('h1'), 'plain post, coloured, vertices');
  assert.ok(spread((await shot(page)).data).deviation > 8);
  assert.deepEqual(page.said, []);
});

test('layers go to the GPU a few at a time', async () => {
  const counts = await page.evaluate(`new kiln.KilnLoader().loadAsync('/large').then((asset) => {
    const counts = [];
    do {
      asset.update(asset.mesh);
      counts.push(asset.textures.planes.layerUpdates.size);
      asset.textures.planes.clearLayerUpdates();
    } while (asset.isUploading);
    return counts;
  })`);
  assert.deepEqual(counts, [4, 3]);
});

test('a telephone: nothing is cut off, fingers turn the view and, on wish, the light', async () => {
  const phone = await openPage(browser, { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true, deviceScaleFactor: 1 });
  await open(phone, '/deep/below/?asset=assets/clustered/pca.json');
  assert.ok(spread((await shot(phone)).data).deviation > 8);
  assert.ok((await phone.evaluate('document.documentElement.scrollWidth')) <= 390);
  const small = await phone.evaluate("[...document.querySelectorAll('button, select, .options label, .row input')].filter((each) => each.checkVisibility() && each.getBoundingClientRect().height < 20).map((each) => each.outerHTML)");
  assert.deepEqual(small, []);
  const session = await phone.context().newCDPSession(phone);
  const touch = (type, points) => session.send('Input.dispatchTouchEvent', { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
  const swipe = async () => {
    await touch('touchStart', [[150, 200]]);
    for (let x = 160; x <= 220; x += 20) await touch('touchMove', [[x, 200]]);
    await touch('touchEnd', []);
    return phone.evaluate('({ azimuth: viewer.store.state.azimuth, eye: viewer.stage.camera.position.toArray(), distance: viewer.stage.camera.position.distanceTo(viewer.stage.controls.target) })');
  };
  const first = await phone.evaluate('({ azimuth: viewer.store.state.azimuth, eye: viewer.stage.camera.position.toArray(), distance: viewer.stage.camera.position.distanceTo(viewer.stage.controls.target) })');
  const turned = await swipe();
  assert.ok(Math.hypot(...turned.eye.map((v, k) => v - first.eye[k])) > 0.1, 'a finger does not turn the view');
  assert.equal(turned.azimuth, first.azimuth);
  await touch('touchStart', [[150, 200], [200, 200]]);
  for (let x = 0; x <= 60; x += 20) await touch('touchMove', [[150 - x, 200], [200 + x, 200]]);
  await touch('touchEnd', []);
  const near = await phone.evaluate('viewer.stage.camera.position.distanceTo(viewer.stage.controls.target)');
  assert.ok(near < 0.8 * first.distance, `two fingers do not zoom: ${near} of ${first.distance}`);
  await phone.tap('.drag');
  const lit = await swipe();
  assert.ok(Math.abs(lit.azimuth - first.azimuth) > 20, 'a finger does not move the light');
  assert.deepEqual([phone.said, phone.elsewhere], [[], []]);
  await phone.context().close();
});

test('a broken asset is told of, and the page stays', async () => {
  const refused = await openPage(browser, { viewport: { width: 800, height: 300 } });
  await open(refused, '/bare/?asset=/deep/below/assets/plain');
  for (const [name, [, message]] of Object.entries(faults)) {
    await refused.evaluate(`viewer.open(new kiln.HttpSource(${JSON.stringify(`/broken/${name}`)}))`);
    const text = await refused.innerText('.notice >> nth=-1');
    assert.match(text, message, name);
    assert.match(text, /expected/, name);
  }
  assert.equal(await refused.locator('.notice').count(), Object.keys(faults).length);
  await refused.click('.notice >> nth=0 >> button');
  assert.equal(await refused.locator('.notice').count(), Object.keys(faults).length - 1);
  assert.ok(spread((await shot(refused)).data).deviation > 8);
  // Requests that fail are the browser's to tell of; nothing else may complain.
  assert.deepEqual(refused.said.filter((text) => !/404/.test(text) && !/Decoding failed|Corrupted|DRACOLoader/i.test(text)), []);
  await open(refused, '/bare/?asset=/nowhere');
  assert.match(await refused.innerText('.notice'), /found neither ranges\.json nor pca\.json/);
  await open(refused, '/bare/?asset=https://example.com/prt');
  assert.match(await refused.innerText('.notice'), /lies on another server/);
  assert.deepEqual(refused.elsewhere, []);
  await refused.context().close();
});

test('a folder that is chosen is opened', async () => {
  const chosen = await openPage(browser, { viewport: { width: 800, height: 300 } });
  await open(chosen, '/deep/below/');
  await chosen.setInputFiles('input[webkitdirectory]', join(assets, 'clustered_coloured'));
  await until(chosen, "document.querySelector('h1').textContent === 'clustered_coloured' && !viewer.stage.shown.some(({ asset }) => asset.isUploading)");
  assert.ok(spread((await shot(chosen)).data).deviation > 8);
  await chosen.setInputFiles('input[accept]', join(assets, 'sky.hdr'));
  await until(chosen, "viewer.store.state.environment === 'file'");
  assert.ok(spread((await shot(chosen)).data).deviation > 2);
  assert.deepEqual([chosen.said, chosen.elsewhere], [[], []]);
  await chosen.context().close();
});

test('<kiln-asset> shows an asset without code, and tells of a broken one', async () => {
  const plain = await openPage(browser);
  await plain.goto(`${server.address}/element.html`);
  await until(plain, "document.querySelector('#a').asset && document.querySelector('#b').shadowRoot.querySelector('p').textContent");
  assert.match(await plain.evaluate("document.querySelector('#b').shadowRoot.querySelector('p').textContent"), /spectral asset/);
  const picture = async () => {
    const text = await plain.evaluate(`document.querySelector('#a').asset.ready.then(() => { const a = document.querySelector('#a'); a.asset.uploadAll(); a.renderer.render(a.scene, a.camera3d); const gl = a.renderer.getContext(); const pixels = new Uint8Array(4 * 200 * 150); gl.readPixels(0, 0, 200, 150, gl.RGBA, gl.UNSIGNED_BYTE, pixels); return btoa(String.fromCharCode(...pixels.subarray(0, 60000)) + String.fromCharCode(...pixels.subarray(60000))); })`);
    return pixelsOf(text, [200, 150]);
  };
  const first = await picture();
  assert.ok(spread(first).deviation > 8 && spread(first).count > 1000);
  await plain.focus('#a');
  await plain.evaluate("document.querySelector('#a').shadowRoot.querySelector('canvas').focus()");
  for (let k = 0; k < 8; ++k) await plain.keyboard.press('Shift+ArrowRight');
  assert.equal(await plain.getAttribute('#a', 'light'), '-20.0,40.0');
  assert.ok(compare(first, await picture(), [200, 150]).mean > 3);
  assert.deepEqual([plain.said, plain.elsewhere], [[], []]);
  await plain.context().close();
});

test('nothing left the origin', () => assert.deepEqual(page.elsewhere, []));

test('without WebGL 2 the page says so', async () => {
  const without = await browse('none');
  try {
    const dark = await openPage(without);
    await dark.goto(`${server.address}/deep/below/`);
    await dark.waitForSelector('.unable');
    assert.match(await dark.innerText('.unable'), /no WebGL 2/);
  } finally {
    await without.close();
  }
});
