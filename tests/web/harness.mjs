// SPDX-License-Identifier: GPL-3.0-or-later
// A server of folders, Chromium, and pictures, for the tests of tools/web.
import { execFile } from 'node:child_process';
import { createReadStream, existsSync, mkdtempSync, readFileSync, rmSync, statSync } from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { extname, join, normalize } from 'node:path';
import { promisify } from 'node:util';
import { decode } from 'fast-png';
import { chromium } from 'playwright-core';

export const sources = process.env.KILN_SOURCES;
export const web = process.env.KILN_WEB;
export const programs = process.env.KILN_PROGRAMS;
export const dist = join(sources, 'tools/web/dist');
export const assets = join(web, 'assets');
export const temporary = mkdtempSync(join(tmpdir(), 'kiln-web-'));
process.on('exit', () => rmSync(temporary, { recursive: true, force: true }));

const types = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.json': 'application/json', '.png': 'image/png' };

/** Serves folders: `roots` maps the beginning of a path to a folder, a file, or a function that returns [type, bytes]. */
export async function serve(roots) {
  const server = createServer((request, response) => {
    const path = decodeURIComponent(new URL(request.url, 'http://localhost').pathname);
    const root = Object.keys(roots).filter((each) => path.startsWith(each)).sort((a, b) => b.length - a.length)[0];
    const found = root && (typeof roots[root] === 'function' ? roots[root](path.slice(root.length)) : join(roots[root], normalize(`/${path.slice(root.length)}`)));
    if (Array.isArray(found)) return response.writeHead(200, { 'content-type': found[0] }).end(found[1]);
    const file = found && existsSync(found) && statSync(found).isDirectory() ? join(found, 'index.html') : found;
    if (!file || !existsSync(file)) return response.writeHead(404).end();
    response.writeHead(200, { 'content-type': types[extname(file)] ?? 'application/octet-stream' });
    createReadStream(file).pipe(response);
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  return { address: `http://127.0.0.1:${server.address().port}`, close: () => server.close() };
}

/** Starts Chromium: on Mesa's llvmpipe, the rasteriser of kiln-render, or on its own SwiftShader. */
export async function browse(rasteriser) {
  const flags = { llvmpipe: ['--use-angle=gl-egl', '--ignore-gpu-blocklist'], swiftshader: ['--enable-unsafe-swiftshader'], none: ['--disable-gpu', '--disable-webgl', '--disable-webgl2', '--disable-3d-apis'] };
  return chromium.launch({
    executablePath: '/usr/bin/chromium',
    headless: true,
    args: ['--no-sandbox', '--disable-background-networking', '--disable-component-update', '--disable-sync', '--host-resolver-rules=MAP * ~NOTFOUND , EXCLUDE 127.0.0.1', ...flags[rasteriser]],
  });
}

/** Waits until an expression of the page is true: Playwright's own way is what a Content-Security-Policy forbids. */
export async function until(page, expression) {
  for (const end = Date.now() + 20_000; Date.now() < end; await new Promise((resolve) => setTimeout(resolve, 30))) if (await page.evaluate(expression)) return;
  throw new Error(`${expression} did not become true`);
}

/**
 * Opens a page that counts what leaves its origin, and keeps what its console says, but for the stall of reading pixels,
 * which is the tests'.
 */
export async function openPage(browser, options = {}) {
  const context = await browser.newContext({ viewport: { width: 640, height: 480 }, ...options });
  const page = await context.newPage();
  page.said = [];
  page.elsewhere = [];
  page.on('console', (message) => ['error', 'warning'].includes(message.type()) && !/GPU stall due to ReadPixels/.test(message.text()) && page.said.push(message.text()));
  page.on('pageerror', (error) => page.said.push(String(error)));
  await context.route('**/*', (route) => {
    const { protocol, hostname } = new URL(route.request().url());
    if (hostname === '127.0.0.1' || protocol === 'blob:' || protocol === 'data:') return route.continue();
    page.elsewhere.push(route.request().url());
    return route.abort();
  });
  return page;
}

/** Draws by kiln-render; RGBA of 8 bits, row 0 at the top. */
export async function render(folder, size, options) {
  const file = join(temporary, `render${Math.random()}.png`);
  await promisify(execFile)(join(programs, 'kiln-render'), [folder, '-o', file, '--width', size[0], '--height', size[1], '--supersample', 1, '--quiet', ...options].map(String));
  const { width, height, data, channels } = decode(readFileSync(file));
  if (width !== size[0] || height !== size[1] || channels !== 4) throw new Error(`kiln-render drew ${width} x ${height} of ${channels} channels`);
  return data;
}

/** Turns the text that a page made of gl.readPixels into RGBA with row 0 at the top. */
export function pixelsOf(text, [width, height]) {
  const upwards = Buffer.from(text, 'base64');
  const data = new Uint8Array(upwards.length);
  for (let row = 0; row < height; ++row) data.set(upwards.subarray((height - 1 - row) * width * 4, (height - row) * width * 4), row * width * 4);
  return data;
}

/** Compares pictures where both have a surface, a pixel and more from its silhouette. Differences are of 255. */
export function compare(a, b, [width, height]) {
  const there = (picture, x, y) => picture[(y * width + x) * 4 + 3] === 255;
  let sum = 0, count = 0, large = 0, most = 0;
  for (let y = 1; y + 1 < height; ++y)
    for (let x = 1; x + 1 < width; ++x) {
      let inside = true;
      for (let dy = -1; dy <= 1; ++dy) for (let dx = -1; dx <= 1; ++dx) inside &&= there(a, x + dx, y + dy) && there(b, x + dx, y + dy);
      if (!inside) continue;
      let here = 0;
      for (let c = 0; c < 3; ++c) {
        const difference = Math.abs(a[(y * width + x) * 4 + c] - b[(y * width + x) * 4 + c]);
        sum += difference;
        here = Math.max(here, difference);
      }
      ++count;
      if (here > 3) ++large;
      most = Math.max(most, here);
    }
  return { mean: sum / (3 * count), large: large / count, most, count };
}

/** Returns the standard deviation of the luminance where there is a surface, of 255, and how many pixels that is. */
export function spread(picture) {
  let [count, sum, squares] = [0, 0, 0];
  for (let i = 0; i < picture.length; i += 4) {
    if (picture[i + 3] !== 255) continue;
    const value = (picture[i] + picture[i + 1] + picture[i + 2]) / 3;
    ++count;
    sum += value;
    squares += value * value;
  }
  return { count, deviation: count === 0 ? 0 : Math.sqrt(Math.max(0, squares / count - (sum / count) ** 2)) };
}
