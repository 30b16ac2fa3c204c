// SPDX-License-Identifier: MIT
// <kiln-asset src="folder/"></kiln-asset>: an asset on a page without code.
import { PerspectiveCamera, Scene, Vector3, WebGLRenderer } from 'three';
import { HDRLoader } from 'three/addons/loaders/HDRLoader.js';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { fitCamera } from './camera';
import type { KilnAsset } from './asset';
import { KilnLoader } from './loader';

const style = `
:host { display: block; position: relative; aspect-ratio: 4 / 3; contain: content; }
canvas { display: block; width: 100%; height: 100%; touch-action: none; outline-offset: 2px; }
p { position: absolute; inset: auto 0 0; margin: 0; padding: 0.75em 1em; font: 0.875rem/1.4 system-ui, sans-serif; color: #fff; background: #8c1d18; overflow-wrap: anywhere; }
p:empty { display: none; }`;

function numbers(text: string | null, otherwise: number[]): number[] {
  if (text === null) return otherwise;
  const values = text.split(/[\s,]+/).filter(Boolean).map(Number);
  return values.length > 0 && values.every(Number.isFinite) ? values : otherwise;
}

/**
 * Attributes: `src`, a folder or a .glb; `light`, "azimuth,elevation" in degrees, and maybe ",r,g,b" (45,30);
 * `ambient`, a radiance (0.1); `environment`, a .hdr in place of the lights unless `light` is there as well; `camera`,
 * "azimuth,elevation" (20,12); `alt`, a description. Drag turns the asset, shift-drag the light; arrow keys as well.
 * Events: `load`, `error` (with `detail`). Properties: `asset`, `camera3d`.
 */
export class KilnAssetElement extends HTMLElement {
  static readonly observedAttributes = ['src', 'light', 'ambient', 'environment', 'camera', 'alt'];

  asset: KilnAsset | null = null;
  readonly camera3d = new PerspectiveCamera(30);
  private readonly scene = new Scene();
  private readonly canvas: HTMLCanvasElement;
  private readonly message: HTMLParagraphElement;
  private renderer: WebGLRenderer | null = null;
  private controls: OrbitControls | null = null;
  private observer: ResizeObserver | null = null;
  private frame = 0;
  private turn = 0;
  private angles = [45, 30];

  constructor() {
    super();
    const root = this.attachShadow({ mode: 'open' });
    // A sheet that is made here is allowed under any Content-Security-Policy.
    const sheet = new CSSStyleSheet();
    sheet.replaceSync(style);
    root.adoptedStyleSheets = [sheet];
    this.canvas = root.appendChild(document.createElement('canvas'));
    this.canvas.tabIndex = 0;
    this.canvas.setAttribute('role', 'img');
    this.message = root.appendChild(document.createElement('p'));
    this.message.setAttribute('role', 'alert');
  }

  connectedCallback(): void {
    try {
      this.renderer = new WebGLRenderer({ canvas: this.canvas, antialias: true, alpha: true });
    } catch {
      this.fail(new Error('This browser has no WebGL 2, which the picture needs.'));
      return;
    }
    this.renderer.setClearColor(0, 0);
    this.controls = new OrbitControls(this.camera3d, this.canvas);
    this.controls.addEventListener('change', () => this.draw());
    this.canvas.addEventListener('pointerdown', this.startLight, { capture: true });
    this.canvas.addEventListener('keydown', this.key);
    this.observer = new ResizeObserver(() => this.resize());
    this.observer.observe(this.canvas);
    this.relabel();
    this.resize();
    void this.open();
  }

  disconnectedCallback(): void {
    cancelAnimationFrame(this.frame);
    this.frame = 0;
    ++this.turn;
    this.observer?.disconnect();
    this.controls?.dispose();
    this.canvas.removeEventListener('pointerdown', this.startLight, { capture: true });
    this.canvas.removeEventListener('keydown', this.key);
    this.asset?.dispose();
    this.asset?.mesh.removeFromParent();
    this.asset = null;
    this.renderer?.dispose();
    this.renderer = null;
  }

  attributeChangedCallback(name: string): void {
    if (!this.renderer) return;
    if (name === 'src') void this.open();
    else if (name === 'camera') this.reframe();
    else if (name === 'alt') this.relabel();
    else void this.relight();
  }

  private relabel(): void {
    this.canvas.setAttribute('aria-label', this.getAttribute('alt') ?? `The asset ${this.getAttribute('src') ?? ''}`);
  }

  private async open(): Promise<void> {
    const src = this.getAttribute('src');
    const turn = ++this.turn;
    this.asset?.mesh.removeFromParent();
    this.asset?.dispose();
    this.asset = null;
    this.message.textContent = '';
    this.draw();
    if (!src) return;
    const loader = new KilnLoader();
    loader.progressive = true;
    try {
      const asset = await loader.loadAsync(src);
      if (turn !== this.turn) return asset.dispose();
      this.asset = asset;
      asset.onchange = () => this.draw();
      this.scene.add(asset.mesh);
      this.reframe();
      await this.relight();
      await asset.ready;
      if (turn === this.turn) this.dispatchEvent(new CustomEvent('load'));
    } catch (error) {
      if (turn === this.turn) this.fail(error);
    }
  }

  private fail(error: unknown): void {
    this.message.textContent = error instanceof Error ? error.message : String(error);
    this.dispatchEvent(new CustomEvent('error', { detail: error }));
  }

  private async relight(): Promise<void> {
    const { asset } = this;
    if (!asset) return;
    const environment = this.getAttribute('environment');
    const given = numbers(this.getAttribute('light'), [45, 30]);
    this.angles = given.slice(0, 2);
    this.setLights(given.slice(2, 5));
    if (!environment) return;
    try {
      const picture = await new HDRLoader().loadAsync(environment);
      if (asset !== this.asset) return;
      asset.light.setEnvironment(picture);
      this.draw();
    } catch (error) {
      this.fail(new Error(`${environment}: the environment could not be read (${error instanceof Error ? error.message : String(error)})`));
    }
  }

  private setLights(color: number[]): void {
    const light = this.asset!.light.clear();
    if (this.hasAttribute('light') || !this.hasAttribute('environment'))
      light.addDirectional(this.angles[0], this.angles[1] ?? 30, color.length === 3 ? (color as [number, number, number]) : 1);
    const ambient = numbers(this.getAttribute('ambient'), this.hasAttribute('environment') ? [0] : [0.1]);
    light.addAmbient(ambient.length === 3 ? (ambient as [number, number, number]) : ambient[0]);
    this.draw();
  }

  private turnLight(azimuth: number, elevation: number): void {
    this.setAttribute('light', [(this.angles[0] + azimuth).toFixed(1), Math.min(90, Math.max(-90, (this.angles[1] ?? 30) + elevation)).toFixed(1), ...numbers(this.getAttribute('light'), []).slice(2)].join());
  }

  private readonly startLight = (event: PointerEvent) => {
    if (!event.shiftKey || event.button !== 0) return;
    event.stopImmediatePropagation();
    event.preventDefault();
    this.canvas.focus();
    this.canvas.setPointerCapture(event.pointerId);
    const move = (moved: PointerEvent) => this.turnLight(moved.movementX * 0.5, -moved.movementY * 0.5);
    this.canvas.addEventListener('pointermove', move);
    this.canvas.addEventListener('lostpointercapture', () => this.canvas.removeEventListener('pointermove', move), { once: true });
  };

  private readonly key = (event: KeyboardEvent) => {
    const step = { ArrowLeft: [-5, 0], ArrowRight: [5, 0], ArrowUp: [0, 5], ArrowDown: [0, -5] }[event.key];
    if (!step || !this.controls) return;
    event.preventDefault();
    if (event.shiftKey) return this.turnLight(step[0], step[1]);
    const offset = this.camera3d.position.clone().sub(this.controls.target);
    const azimuth = Math.atan2(offset.x, offset.z) - (step[0] * Math.PI) / 180;
    const elevation = Math.min(1.5, Math.max(-1.5, Math.asin(offset.y / offset.length()) + (step[1] * Math.PI) / 180));
    const direction = new Vector3(Math.cos(elevation) * Math.sin(azimuth), Math.sin(elevation), Math.cos(elevation) * Math.cos(azimuth));
    this.camera3d.position.copy(this.controls.target).addScaledVector(direction, offset.length());
    this.controls.update();
  };

  private reframe(): void {
    if (!this.asset) return;
    const [azimuth, elevation] = numbers(this.getAttribute('camera'), [20, 12]);
    this.controls!.target.copy(fitCamera(this.camera3d, this.asset.mesh, { azimuth, elevation }));
    this.controls!.update();
    this.draw();
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (!this.renderer || width === 0 || height === 0) return;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setSize(width, height, false);
    this.camera3d.aspect = width / height;
    this.camera3d.updateProjectionMatrix();
    this.draw();
  }

  private draw(): void {
    this.frame ||= requestAnimationFrame(() => {
      this.frame = 0;
      this.renderer?.render(this.scene, this.camera3d);
    });
  }
}

/** Registers the element; importing the bundle does so. */
export function defineKilnAsset(name = 'kiln-asset'): void {
  if (!customElements.get(name)) customElements.define(name, KilnAssetElement);
}
