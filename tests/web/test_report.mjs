// SPDX-License-Identifier: GPL-3.0-or-later
// A report from the disk, as people read it: with scripts and without, on a telephone, on paper, by keys.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { assets, browse, until } from './harness.mjs';

const address = pathToFileURL(join(assets, 'out/post/report.html')).href;
const axe = readFileSync(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');
let browser, shared;

before(async () => {
  browser = await browse('swiftshader');
  shared = await open();
  await until(shared, "document.querySelector('.cover.is-live') !== null");
});
after(() => browser?.close());

/** Opens the report; `page.asked` lists what it asks for besides itself. */
async function open(options = {}, by = browser) {
  const page = await (await by.newContext({ viewport: { width: 1280, height: 800 }, ...options })).newPage();
  page.said = [];
  page.asked = [];
  page.on('console', (message) => ['error', 'warning'].includes(message.type()) && !/GPU stall due to ReadPixels/.test(message.text()) && page.said.push(message.text()));
  page.on('pageerror', (error) => page.said.push(String(error)));
  page.on('request', (request) => !/^(data|blob):/.test(request.url()) && request.url() !== address && page.asked.push(request.url()));
  await page.goto(address);
  return page;
}

/** Returns the live picture, as bytes of a PNG. */
const shot = (page) => page.locator('.cover canvas').screenshot();

/** Lists what axe-core finds serious or critical. */
async function faults(page) {
  await page.evaluate(axe);
  const { violations } = await page.evaluate("axe.run(document, { resultTypes: ['violations'] })");
  return violations.filter(({ impact }) => ['serious', 'critical'].includes(impact)).map(({ id, nodes }) => `${id}: ${nodes.slice(0, 3).map(({ html, failureSummary }) => `${html.slice(0, 120)} ${failureSummary}`).join('; ')}`);
}

test('the live picture is that of kiln-render', async () => {
  const page = shared;
  await page.waitForTimeout(300);
  // Both at 64 pixels a side, those of the surface: test_pictures compares pixel by pixel.
  const { still, live } = await page.evaluate(`(async () => {
    const small = (picture) => {
      const canvas = document.createElement('canvas');
      canvas.width = canvas.height = 64;
      const context = canvas.getContext('2d');
      context.fillStyle = '#33312f';
      context.fillRect(0, 0, 64, 64);
      context.imageSmoothingQuality = 'high';
      context.drawImage(picture, 0, 0, 64, 64);
      return context.getImageData(0, 0, 64, 64).data;
    };
    const still = small(document.querySelector('.cover img'));
    // Move the light there and back, so that there is a picture in the frame that follows.
    const canvas = document.querySelector('.cover canvas');
    for (const key of ['ArrowLeft', 'ArrowRight']) canvas.dispatchEvent(new KeyboardEvent('keydown', { key, shiftKey: true }));
    const live = await new Promise((resolve) => requestAnimationFrame(() => resolve(small(canvas))));
    const mean = (data) => {
      let [count, sum, squares] = [0, 0, 0];
      for (let k = 0; k < data.length; k += 4) if (data[k] > 70) [count, sum, squares] = [count + 1, sum + data[k], squares + data[k] ** 2];
      return { count, mean: sum / count, deviation: Math.sqrt(squares / count - (sum / count) ** 2) };
    };
    return { still: mean(still), live: mean(live) };
  })()`);
  assert.ok(still.count > 500 && still.deviation > 10, JSON.stringify(still));
  // The still picture is cut to its asset with another margin, so places differ by a pixel of these.
  assert.ok(Math.abs(live.count / still.count - 1) < 0.1, JSON.stringify({ still, live }));
  assert.ok(Math.abs(live.mean - still.mean) < 3 && Math.abs(live.deviation - still.deviation) < 4, JSON.stringify({ still, live }));
});

test('the first screen says what matters, and the asset is live', async () => {
  const page = shared;
  const first = await page.evaluate("(() => { const header = document.querySelector('header'); return { text: header.innerText, bottom: header.getBoundingClientRect().bottom }; })()");
  for (const wanted of [/post/, /budget/i, /%\s+is what a viewer may expect/, /On disk/i, /On the GPU/i, /Lookups/i, /Made in/i, /Kiln 0\.1\.0, on \S+, \d{4}-\d\d-\d\d/, /would help most/]) assert.match(first.text, wanted);
  assert.ok(first.bottom <= 800, `the first screen ends at ${first.bottom} of 800 pixels`);
  const before = await shot(page);
  await page.focus('.cover canvas');
  for (let k = 0; k < 12; ++k) await page.keyboard.press('Shift+ArrowRight');
  await page.waitForTimeout(300);
  const lit = await shot(page);
  assert.notDeepEqual(lit, before, 'keys do not move the light');
  for (let k = 0; k < 9; ++k) await page.keyboard.press('ArrowLeft');
  await page.waitForTimeout(300);
  assert.notDeepEqual(await shot(page), lit, 'keys do not turn the asset');
  const box = await page.locator('.cover canvas').boundingBox();
  const turned = await shot(page);
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width / 4, box.y + box.height / 2, { steps: 4 });
  await page.mouse.up();
  await page.waitForTimeout(300);
  assert.notDeepEqual(await shot(page), turned, 'a pointer does not turn the asset');
  assert.deepEqual([page.said, page.asked], [[], []]);
});

test('tables sort by their columns', async () => {
  const page = shared;
  const column = (head) => page.evaluate(`(() => { const table = [...document.querySelectorAll('table.sortable')].find((each) => each.tHead.innerText.includes('Error')); const at = [...table.tHead.rows[0].cells].findIndex((each) => each.innerText.trim() === '${head}'); return [...table.tBodies[0].rows].map((row) => parseFloat(row.cells[at].innerText)); })()`);
  const button = page.locator('table.sortable .sort', { hasText: /^Error$/ });
  await button.click();
  const up = await column('Error');
  assert.deepEqual(up, [...up].sort((a, b) => a - b));
  await button.click();
  assert.deepEqual(await column('Error'), [...up].reverse());
  assert.equal(await page.locator('th[aria-sort=descending]').count(), 1);
});

test('pictures open, swap in place and close by keys', async () => {
  const page = shared;
  const look = page.locator('.quartet .look').first();
  await look.focus();
  await page.keyboard.press('Enter');
  const shown = () => page.evaluate("(() => { const at = document.querySelector('.lightbox img'); return [at.alt.split(':')[0], at.getBoundingClientRect().width]; })()");
  const [name, width] = await shown();
  assert.equal(name, 'Asset');
  assert.ok(width > 300, `the picture is ${width} pixels wide`);
  await page.keyboard.press('2');
  assert.equal((await shown())[0], 'Reference');
  await page.keyboard.press('ArrowRight');
  assert.equal((await shown())[0], 'Difference');
  await page.keyboard.press('+');
  assert.ok((await shown())[1] > 1.2 * width);
  await page.keyboard.press('Escape');
  assert.equal(await page.locator('.lightbox[open]').count(), 0);
  assert.ok(await look.evaluate((each) => each === document.activeElement), 'the focus does not come back');
});

test('a telephone shows all of it', async () => {
  const page = await open({ viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true, javaScriptEnabled: false });
  const { width, cut } = await page.evaluate(`({
    width: document.documentElement.scrollWidth,
    cut: [...document.querySelectorAll('td, .figures dd, h1, h2, .found')].filter((each) => each.getBoundingClientRect().right > 391 && !each.closest('details')).map((each) => each.innerText).slice(0, 5),
  })`);
  assert.ok(width <= 390, `the page is ${width} pixels wide`);
  assert.deepEqual(cut, []);
  await page.context().close();
});

test('without scripts the page is whole', async () => {
  const page = await open({ javaScriptEnabled: false });
  assert.ok(await page.locator('.cover img').isVisible());
  assert.ok((await page.locator('figure img').count()) > 8);
  assert.match(await page.innerText('main'), /Where the error comes from/);
  assert.equal(await page.locator('.hint').count(), 0);
  await page.context().close();
});

test('on paper it takes three to five pages', async () => {
  const page = shared;
  const pdf = (await page.pdf({ preferCSSPageSize: true })).toString('latin1');
  const pages = pdf.match(/\/Type\s*\/Page\b/g).length;
  assert.ok(pages >= 3 && pages <= 5, `${pages} pages`);
});

test('axe-core finds nothing serious, in light and in dark', async () => {
  for (const colorScheme of ['light', 'dark']) {
    await shared.emulateMedia({ colorScheme });
    assert.deepEqual(await faults(shared), [], colorScheme);
  }
});

test('without WebGL 2 the still picture stays, and the page says why', async () => {
  const blind = await browse('none');
  const page = await open({}, blind);
  await until(page, "document.querySelector('.hint') !== null");
  assert.match(await page.innerText('.hint'), /The picture stands still: .*WebGL/);
  assert.ok(await page.locator('.cover img').isVisible());
  await blind.close();
});
