// SPDX-License-Identifier: MIT
// The viewer page, in one file with all it needs. Importing it defines <kiln-asset>; on a page whose body has the
// attribute `data-kiln-viewer` it opens the viewer as well.
import { HDRLoader } from 'three/addons/loaders/HDRLoader.js';
import { DataUtils, HalfFloatType } from 'three';
import { pngDecoder } from '../decoder';
import { warmDraco } from '../draco';
import { defineKilnAsset } from '../element';
import { KilnLoader } from '../loader';
import { HttpSource, type AssetSource } from '../sources';
import { GlbSource } from '../glb';
import type { RadiancePicture } from '../environment';
import { el } from './elements';
import { type Dropped, filesOfDrop, filesOfInput, sortFiles } from './files';
import { helpDialog } from './help';
import { makePanel, makeReadout } from './panel';
import { Stage } from './stage';
import { firstState, Store } from './state';
import './viewer.css';

export * from '../index';

/** An entry of assets.json. */
interface Listed {
  name: string;
  path: string;
}

export class Viewer {
  readonly store = new Store();
  readonly stage: Stage;
  private readonly loader = new KilnLoader();
  private readonly title = el('h1', {}, 'Kiln');
  private readonly form = el('p', { class: 'form' });
  private readonly list = el('ul', { class: 'assets', hidden: '' });
  private readonly notices = el('div', { class: 'notices', role: 'alert' });
  private readonly busy = el('div', { class: 'busy', role: 'progressbar', 'aria-label': 'Loading' });
  private readonly welcome: HTMLElement;
  private readonly panel: ReturnType<typeof makePanel>;
  private readonly readout: ReturnType<typeof makeReadout>;
  private listed: Listed[] = [];
  private loading = 0;

  /** Resolves when what the address names has been opened, or has failed. */
  readonly opened: Promise<void>;

  /** Throws where there is no WebGL 2. */
  constructor(root: HTMLElement) {
    const canvas = el('canvas', { tabindex: '0', 'aria-label': 'The asset. Arrow keys turn it, with shift the light; plus and minus zoom.', role: 'application' });
    const picture = el('div', { class: 'picture' }, canvas);
    root.append(el('main', { class: 'viewer' }, picture));
    this.stage = new Stage(canvas, this.store);
    this.stage.onerror = (error) => this.fail(error);
    this.readout = makeReadout(this.stage);
    this.welcome = el('div', { class: 'welcome', hidden: '' }, el('p', {}, 'Drop a baked folder here'),
      el('p', {}, 'the output of kiln-bake or kiln-compress, or a .glb of kiln export.'));
    const help = helpDialog();
    const folderInput = el('input', { type: 'file', webkitdirectory: '', hidden: '', 'aria-label': 'Folder of an asset' });
    const fileInput = el('input', { type: 'file', accept: '.glb,.hdr', multiple: '', hidden: '', 'aria-label': 'Files' });
    for (const input of [folderInput, fileInput])
      input.addEventListener('change', () => {
        void sortFiles(filesOfInput(input)).then((dropped) => this.take(dropped));
        input.value = '';
      });
    fileInput.addEventListener('cancel', () => {
      if (this.store.state.environment === 'file' && !this.stage.environment) this.store.set({ environment: 'none' });
    });
    this.panel = makePanel(this.store, this.stage, {
      openFolder: () => folderInput.click(),
      openFile: () => fileInput.click(),
      openEnvironment: () => fileInput.click(),
      reset: () => this.reset(),
      help: () => help.showModal(),
      picture: () => this.savePicture(),
    });
    const drag = el('button', { type: 'button', class: 'drag' });
    drag.addEventListener('click', () => this.store.set({ drag: this.store.state.drag === 'view' ? 'light' : 'view' }));
    this.store.watch(() => {
      const light = this.store.state.drag === 'light';
      drag.textContent = light ? 'Drag moves the light' : 'Drag turns the view';
      drag.setAttribute('aria-pressed', String(light));
    });
    picture.append(el('header', {}, this.title, this.form), this.divider(), this.welcome, this.notices, this.busy,
      el('footer', {}, this.readout.element, drag));
    root.querySelector('main')!.append(el('aside', { class: 'panel', 'aria-label': 'Controls' }, this.list, this.panel.element));
    root.append(help, folderInput, fileInput);
    this.stage.ontime = (milliseconds) => this.readout.time(milliseconds);
    canvas.addEventListener('keydown', (event) => this.key(event, help));
    this.acceptDrops(root);
    this.opened = this.openAddress();
    addEventListener('hashchange', () => void this.openAddress());
  }

  /** Opens what the address names: ?asset=PATH, once or several times, or the list of assets.json. */
  private async openAddress(): Promise<void> {
    const named = new URLSearchParams(location.search).getAll('asset').filter(Boolean);
    if (named.length > 0) return void (await Promise.all(named.map((path, order) => this.openPath(path, order))));
    await this.readList();
    const chosen = new URLSearchParams(location.hash.slice(1)).getAll('asset').filter((path) => this.listed.some((each) => each.path === path));
    const wanted = chosen.length > 0 ? chosen : this.listed.slice(0, 1).map((each) => each.path);
    this.welcome.hidden = wanted.length > 0;
    for (const { asset } of [...this.stage.shown]) if (!wanted.includes(asset.mesh.userData.path as string)) this.stage.remove(asset);
    const open = new Set(this.stage.shown.map(({ asset }) => asset.mesh.userData.path as string));
    await Promise.all(wanted.filter((path) => !open.has(path)).map((path) => this.openPath(path, this.listed.findIndex((each) => each.path === path))));
    this.refresh();
  }

  private async readList(): Promise<void> {
    if (this.listed.length > 0) return;
    try {
      const response = await fetch(new URL('assets.json', document.baseURI));
      if (response.ok) this.listed = ((await response.json()) as { assets?: Listed[] }).assets ?? [];
    } catch {
      this.listed = [];
    }
    for (const { name, path } of this.listed) {
      const only = el('a', { href: `#asset=${encodeURIComponent(path)}` }, name);
      const also = el('input', { type: 'checkbox', 'aria-label': `Show ${name} beside the others` });
      also.addEventListener('change', () => {
        const open = this.listed.map((each) => each.path).filter((each) => (each === path ? also.checked : this.isOpen(each)));
        location.hash = open.map((each) => `asset=${encodeURIComponent(each)}`).join('&');
        if (open.length === 0) also.checked = true;
      });
      this.list.append(el('li', {}, only, also));
    }
    this.list.hidden = this.listed.length < 2;
  }

  private isOpen(path: string): boolean {
    return this.stage.shown.some(({ asset }) => asset.mesh.userData.path === path);
  }

  private async openPath(path: string, order: number): Promise<void> {
    const source = /\.glb$/i.test(path) ? new GlbSource(path) : new HttpSource(path);
    if (new URL(path, document.baseURI).origin !== location.origin) return this.fail(new Error(`${path} lies on another server. This page asks no other server for anything; copy the folder beside it.`));
    await this.open(source, path, order);
  }

  /** Loads an asset and shows it beside those that are there. */
  async open(source: AssetSource, path = source.name, order = 0): Promise<void> {
    this.welcome.hidden = true;
    this.setLoading(1);
    try {
      this.loader.progressive = true;
      const asset = await this.loader.loadSource(source);
      asset.mesh.userData.path = path;
      this.stage.add(asset, order);
      this.refresh();
      await asset.ready;
      this.refresh();
    } catch (error) {
      this.fail(error);
    } finally {
      this.setLoading(-1);
    }
  }

  private setLoading(by: number): void {
    this.loading += by;
    this.busy.hidden = this.loading === 0;
  }

  private refresh(): void {
    const assets = this.stage.shown.map(({ asset }) => asset);
    const names = assets.map((asset) => this.listed.find((each) => each.path === asset.mesh.userData.path)?.name ?? shortName(asset.source.name));
    this.title.textContent = names.join(', ') || 'Kiln';
    document.title = names.length > 0 ? `${names.join(', ')} · Kiln` : 'Kiln';
    this.form.textContent = assets.length === 1 ? `${assets[0].form}${assets[0].manifest.width > 0 ? `, ${assets[0].manifest.width} × ${assets[0].manifest.height}` : ''}, ${assets[0].manifest.bands} bands` : assets.length > 1 ? `${assets.length} assets` : '';
    for (const [k, item] of [...this.list.children].entries()) {
      const open = this.isOpen(this.listed[k].path);
      item.querySelector('input')!.checked = open;
      if (open) item.querySelector('a')!.setAttribute('aria-current', 'true');
      else item.querySelector('a')!.removeAttribute('aria-current');
    }
    this.panel.refresh();
    this.readout.refresh();
  }

  private fail(error: unknown): void {
    const text = error instanceof Error ? error.message : String(error);
    const notice = el('div', { class: 'notice' }, el('p', {}, text));
    const close = el('button', { type: 'button', 'aria-label': 'Close the message' }, '×');
    close.addEventListener('click', () => notice.remove());
    notice.append(close);
    this.notices.append(notice);
  }

  private async take(dropped: Dropped): Promise<void> {
    if (dropped.sources.length === 0 && dropped.environments.length === 0)
      return this.fail(new Error('No asset was found in these files. Drop a folder that has ranges.json or pca.json, a .glb of kiln export, or a .hdr as surroundings.'));
    for (const file of dropped.environments.slice(0, 1)) await this.takeEnvironment(file);
    if (dropped.sources.length > 0) for (const { asset } of [...this.stage.shown]) this.stage.remove(asset);
    await Promise.all(dropped.sources.map((source, order) => this.open(source, source.name, order)));
  }

  private async takeEnvironment(file: File): Promise<void> {
    try {
      const parsed = new HDRLoader().parse(await file.arrayBuffer()) as { width: number; height: number; data: Uint16Array | Float32Array; type: number };
      const half = parsed.type === HalfFloatType;
      const picture: RadiancePicture = { width: parsed.width, height: parsed.height, stride: 4, data: parsed.data, decode: half ? (value) => DataUtils.fromHalfFloat(value) : (value) => value, topFirst: true };
      this.stage.environment = picture;
      this.store.set({ environment: 'file', light: 'none', fill: 0 });
      this.stage.relight();
    } catch (error) {
      this.fail(new Error(`${file.name}: no Radiance picture (${error instanceof Error ? error.message : String(error)})`));
      if (!this.stage.environment) this.store.set({ environment: 'none' });
    }
  }

  private reset(): void {
    const bands = Math.max(1, ...this.stage.shown.map(({ asset }) => asset.manifest.bands));
    this.store.set({ ...firstState, bands });
    this.stage.reframe();
  }

  private savePicture(): void {
    this.stage.render();
    this.stage.canvas.toBlob((blob) => {
      if (!blob) return;
      const link = el('a', { href: URL.createObjectURL(blob), download: `${this.title.textContent || 'kiln'}.png` });
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
    });
  }

  /** The line between the picture with transfer and the one without. */
  private divider(): HTMLElement {
    const handle = el('div', { class: 'divider', role: 'slider', tabindex: '0', 'aria-label': 'Part of the picture with transfer', 'aria-valuemin': '0', 'aria-valuemax': '100', hidden: '' },
      el('span', { class: 'left' }, 'with transfer'), el('span', { class: 'grip' }), el('span', { class: 'right' }, 'without'));
    const to = (split: number) => this.store.set({ split: Math.min(1, Math.max(0, split)) });
    handle.addEventListener('pointerdown', (event) => {
      handle.setPointerCapture(event.pointerId);
      const box = this.stage.canvas.getBoundingClientRect();
      const move = (moved: PointerEvent) => to((moved.clientX - box.left) / box.width);
      handle.addEventListener('pointermove', move);
      handle.addEventListener('lostpointercapture', () => handle.removeEventListener('pointermove', move), { once: true });
    });
    handle.addEventListener('keydown', (event) => {
      const step = { ArrowLeft: -0.02, ArrowDown: -0.02, ArrowRight: 0.02, ArrowUp: 0.02, PageDown: -0.1, PageUp: 0.1, Home: -1, End: 1 }[event.key];
      if (step === undefined) return;
      event.preventDefault();
      to(this.store.state.split + step);
    });
    this.store.watch(() => {
      const { compare, show, split } = this.store.state;
      handle.hidden = !compare || show !== 'picture';
      handle.style.left = `${100 * split}%`;
      handle.setAttribute('aria-valuenow', String(Math.round(100 * split)));
    });
    return handle;
  }

  private key(event: KeyboardEvent, help: HTMLDialogElement): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const { store, stage } = this;
    const arrows = { ArrowLeft: [-5, 0], ArrowRight: [5, 0], ArrowUp: [0, 5], ArrowDown: [0, -5] }[event.key];
    const last = Math.max(1, ...stage.shown.map(({ asset }) => asset.manifest.bands ** 2)) - 1;
    const steps: Record<string, () => void> = {
      '+': () => stage.zoom(0.9), '=': () => stage.zoom(0.9), '-': () => stage.zoom(1 / 0.9),
      p: () => store.set({ show: 'picture', compare: false, technique: 'transfer' }), c: () => store.set({ show: 'charts' }),
      n: () => store.set({ show: 'normals' }), w: () => store.set({ wireframe: !store.state.wireframe }),
      d: () => store.set({ show: 'picture', compare: !store.state.compare }),
      '.': () => store.set(store.state.show === 'coefficient' ? { coefficient: Math.min(last, store.state.coefficient + 1) } : { show: 'coefficient' }),
      ',': () => store.set(store.state.show === 'coefficient' ? { coefficient: Math.max(0, store.state.coefficient - 1) } : { show: 'coefficient' }),
      r: () => this.reset(), l: () => store.set({ drag: store.state.drag === 'view' ? 'light' : 'view' }), '?': () => help.showModal(), h: () => help.showModal(),
    };
    if (arrows) {
      if (event.shiftKey) stage.turnLight(arrows[0], arrows[1]);
      else stage.turnView(-arrows[0], arrows[1]);
    } else if (steps[event.key]) steps[event.key]();
    else return;
    event.preventDefault();
  }

  private acceptDrops(root: HTMLElement): void {
    root.addEventListener('dragover', (event) => {
      event.preventDefault();
      root.classList.add('dropping');
    });
    root.addEventListener('dragleave', (event) => {
      if (!event.relatedTarget) root.classList.remove('dropping');
    });
    root.addEventListener('drop', (event) => {
      event.preventDefault();
      root.classList.remove('dropping');
      if (event.dataTransfer) void filesOfDrop(event.dataTransfer).then(sortFiles).then((dropped) => this.take(dropped));
    });
  }
}

/** Returns the part of a path that tells assets apart: the folder above `prt`. */
function shortName(name: string): string {
  const parts = name.split('/').filter((part) => part !== '' && part !== '.' && part !== '..');
  const last = parts.at(-1) ?? name;
  return (/^(prt|small|vertices)$/.test(last) && parts.length > 1 ? parts.at(-2)! : last).replace(/\.glb$/i, '');
}

/** Opens the viewer, or says why it cannot. */
export function openViewer(root: HTMLElement): Viewer | null {
  // Workers start while WebGL does.
  warmDraco();
  pngDecoder.warm();
  try {
    return new Viewer(root);
  } catch (error) {
    root.replaceChildren(el('main', { class: 'unable', role: 'alert' }, el('h1', {}, 'No picture here'),
      el('p', {}, 'This browser has no WebGL 2, or it is turned off. Turn hardware acceleration on in its settings, or open this page in a recent Chrome, Firefox, Edge or Safari.'),
      el('p', { class: 'detail' }, error instanceof Error ? error.message : String(error))));
    return null;
  }
}

defineKilnAsset();

/** The viewer of this page, if it is a viewer's page. */
export const viewer: Viewer | null = document.body?.hasAttribute('data-kiln-viewer') ? openViewer(document.body) : null;
