// SPDX-License-Identifier: MIT
// The asset in the page, live: drag turns it, shift-drag moves the light.
import { PerspectiveCamera, Scene, Vector3, WebGLRenderer } from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import type { KilnAsset } from '../asset';
import { fitCamera } from '../camera';
import { KilnLoader } from '../loader';
import { FilesSource } from '../sources';

/** What the page embeds: the files of prt/, or of its compressed form, each as base64. */
interface Embedded {
  name: string;
  camera: [number, number]; // azimuth and elevation, degrees
  light: [number, number];
  files: Record<string, string>;
}

function bytesOf(base64: string): Uint8Array<ArrayBuffer> {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let k = 0; k < text.length; ++k) bytes[k] = text.charCodeAt(k);
  return bytes;
}

/** The picture in place of the page's first one. */
class Live {
  private readonly canvas = document.createElement('canvas');
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly camera = new PerspectiveCamera(30);
  private readonly controls: OrbitControls;
  private asset: KilnAsset | null = null;
  private frame = 0;
  private azimuth: number;
  private elevation: number;

  /** Throws where there is no WebGL 2. */
  constructor(
    private readonly place: HTMLElement,
    private readonly embedded: Embedded,
  ) {
    [this.azimuth, this.elevation] = embedded.light;
    this.renderer = new WebGLRenderer({ canvas: this.canvas, antialias: true, alpha: true });
    this.renderer.setClearColor(0, 0);
    this.canvas.tabIndex = 0;
    this.canvas.setAttribute('role', 'img');
    this.canvas.setAttribute('aria-label', `${embedded.name}, live: arrow keys turn it, with Shift they move the light`);
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.enableZoom = false; // the page scrolls
    this.controls.addEventListener('change', () => this.draw());
    this.canvas.addEventListener('pointerdown', (event) => this.press(event), { capture: true });
    this.canvas.addEventListener('keydown', (event) => this.key(event));
  }

  async open(): Promise<void> {
    const files = new Map(Object.entries(this.embedded.files).map(([name, text]) => [name, new Blob([bytesOf(text)])]));
    this.asset = await new KilnLoader().loadSource(new FilesSource(this.embedded.name, files));
    this.asset.onchange = () => this.draw();
    this.scene.add(this.asset.mesh);
    const picture = this.place.querySelector('img')!;
    this.canvas.style.aspectRatio = `${picture.width} / ${picture.height}`;
    picture.hidden = true;
    const hint = document.createElement('p');
    hint.className = 'hint on-screen';
    hint.textContent = 'Drag to turn it, Shift-drag for the light.';
    this.place.append(this.canvas, hint);
    this.place.classList.add('is-live');
    new ResizeObserver(() => this.resize()).observe(this.canvas);
    this.light();
    this.resize();
    const [azimuth, elevation] = this.embedded.camera;
    this.controls.target.copy(fitCamera(this.camera, this.asset.mesh, { azimuth, elevation }));
    this.controls.update();
  }

  private light(): void {
    this.asset?.light.setDirectional(this.azimuth, this.elevation, 1);
    this.draw();
  }

  private resize(): void {
    const { clientWidth, clientHeight } = this.canvas;
    this.renderer.setPixelRatio(window.devicePixelRatio);
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.camera.aspect = clientWidth / Math.max(1, clientHeight);
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  private draw(): void {
    if (this.frame === 0)
      this.frame = requestAnimationFrame(() => {
        this.frame = 0;
        this.renderer.render(this.scene, this.camera);
      });
  }

  private moveLight(azimuth: number, elevation: number): void {
    this.azimuth = (this.azimuth + azimuth + 540) % 360 - 180;
    this.elevation = Math.max(-90, Math.min(90, this.elevation + elevation));
    this.light();
  }

  private press(event: PointerEvent): void {
    if (!event.shiftKey) return;
    event.stopImmediatePropagation();
    event.preventDefault();
    this.canvas.focus();
    this.canvas.setPointerCapture(event.pointerId);
    let { clientX, clientY } = event;
    const move = (next: PointerEvent) => {
      this.moveLight((next.clientX - clientX) / 2, -(next.clientY - clientY) / 2);
      ({ clientX, clientY } = next);
    };
    this.canvas.addEventListener('pointermove', move);
    const end = () => this.canvas.removeEventListener('pointermove', move);
    this.canvas.addEventListener('pointerup', end, { once: true });
    this.canvas.addEventListener('pointercancel', end, { once: true });
  }

  private key(event: KeyboardEvent): void {
    const steps: Record<string, [number, number]> = { ArrowLeft: [-5, 0], ArrowRight: [5, 0], ArrowUp: [0, 5], ArrowDown: [0, -5] };
    const step = steps[event.key];
    if (!step || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    if (event.shiftKey) {
      this.moveLight(...step);
      return;
    }
    const offset = this.camera.position.clone().sub(this.controls.target);
    const turn = (-step[0] * Math.PI) / 180;
    offset.applyAxisAngle(new Vector3(0, 1, 0), turn);
    const side = new Vector3(0, 1, 0).cross(offset).normalize();
    const raised = offset.clone().applyAxisAngle(side, (-step[1] * Math.PI) / 180);
    if (Math.abs(raised.y) < 0.995 * raised.length()) offset.copy(raised);
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
    this.draw();
  }
}

/** Puts the asset in place of its first picture; the picture stays where that cannot be. */
export function mountLive(root: ParentNode): void {
  const script = root.querySelector<HTMLScriptElement>('script#kiln-asset');
  const place = root.querySelector<HTMLElement>('.cover');
  if (!script?.textContent || !place) return;
  const embedded = JSON.parse(script.textContent) as Embedded;
  const start = async () => {
    try {
      await new Live(place, embedded).open();
    } catch (error) {
      const note = document.createElement('p');
      note.className = 'hint on-screen';
      note.textContent = `The picture stands still: ${error instanceof Error ? error.message : String(error)}`;
      place.append(note);
    }
  };
  void start();
}
