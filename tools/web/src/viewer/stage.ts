// SPDX-License-Identifier: MIT
// The picture: camera, assets side by side, with and without transfer.
import { Box3, LinearToneMapping, LineBasicMaterial, LineSegments, NoToneMapping, PerspectiveCamera, Scene, Vector3, WebGLRenderer, WireframeGeometry } from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import type { KilnAsset } from '../asset';
import { fitCamera } from '../camera';
import { directionOf } from '../harmonics';
import type { RadiancePicture } from '../environment';
import { applyLight } from './lighting';
import { PlainView } from './plain';
import type { State, Store } from './state';

interface Shown {
  order: number;
  asset: KilnAsset;
  plain: PlainView;
  edges: LineSegments | null;
}

export class Stage {
  readonly renderer: WebGLRenderer;
  readonly camera = new PerspectiveCamera(30);
  readonly controls: OrbitControls;
  readonly shown: Shown[] = [];
  /** The environment of a file. */
  environment: RadiancePicture | null = null;
  /** Called with the milliseconds that a picture took, of some pictures. */
  ontime: (milliseconds: number) => void = () => {};
  onerror: (error: unknown) => void = () => {};

  private readonly withTransfer = new Scene();
  private readonly without = new Scene();
  private readonly lines = new Scene();
  private readonly sun: HTMLElement;
  private frame = 0;
  private drawn = 0;
  private touched = false;
  private first = true;

  /** Throws where there is no WebGL 2. */
  constructor(
    readonly canvas: HTMLCanvasElement,
    readonly store: Store,
  ) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true, powerPreference: 'high-performance' });
    this.renderer.setClearColor(0, 0);
    this.renderer.autoClear = false;
    for (const scene of [this.withTransfer, this.without, this.lines]) scene.matrixWorldAutoUpdate = false;
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener('change', () => this.draw());
    this.controls.addEventListener('start', () => (this.touched = true));
    this.sun = canvas.parentElement!.appendChild(document.createElement('div'));
    this.sun.className = 'sun';
    this.sun.hidden = true;
    new ResizeObserver(() => this.resize()).observe(canvas);
    canvas.addEventListener('pointerdown', this.startLight, { capture: true });
    canvas.addEventListener('webglcontextlost', (event) => event.preventDefault());
    canvas.addEventListener('webglcontextrestored', () => this.draw());
    store.watch((changed) => this.follow(changed));
    this.resize();
  }

  /** Shows an asset to the right of those of a lower order. */
  add(asset: KilnAsset, order = this.shown.length): void {
    const plain = new PlainView(asset);
    this.shown.push({ order, asset, plain, edges: null });
    this.shown.sort((a, b) => a.order - b.order);
    asset.onchange = () => this.draw();
    asset.mesh.matrixWorldAutoUpdate = true;
    this.withTransfer.add(asset.mesh);
    this.without.add(plain.mesh);
    this.place();
    this.follow(new Set(Object.keys(this.store.state) as (keyof State)[]));
    if (!this.touched) this.reframe();
  }

  remove(asset: KilnAsset): void {
    const at = this.shown.findIndex((each) => each.asset === asset);
    if (at < 0) return;
    const [{ plain, edges }] = this.shown.splice(at, 1);
    for (const object of [asset.mesh, plain.mesh, edges]) object?.removeFromParent();
    edges?.geometry.dispose();
    plain.dispose();
    asset.dispose();
    this.place();
    this.draw();
  }

  /** Puts the assets side by side on one ground, a tenth of the wider one's width between two. */
  private place(): void {
    let edge = 0;
    let before = 0;
    this.shown.forEach(({ asset, plain, edges }, k) => {
      const box = asset.mesh.geometry.boundingBox!;
      const width = box.max.x - box.min.x;
      const first = this.shown[0].asset.mesh.geometry.boundingBox!;
      if (k === 0) {
        asset.mesh.position.set(0, 0, 0);
        edge = box.max.x;
      } else {
        const gap = 0.1 * Math.max(width, before);
        asset.mesh.position.set(edge + gap - box.min.x, first.min.y - box.min.y, (first.min.z + first.max.z - box.min.z - box.max.z) / 2);
        edge += gap + width;
      }
      before = width;
      asset.mesh.updateMatrixWorld(true);
      for (const object of [plain.mesh, edges]) object?.matrixWorld.copy(asset.mesh.matrixWorld);
    });
  }

  /** Shows all assets from the front, as kiln-render does. */
  reframe(): void {
    this.touched = false;
    if (this.shown.length === 0) return;
    const points: Vector3[] = [];
    for (const { asset } of this.shown) {
      const position = asset.mesh.geometry.attributes.position;
      for (let i = 0; i < position.count; ++i) points.push(new Vector3().fromBufferAttribute(position, i).applyMatrix4(asset.mesh.matrixWorld));
    }
    const box = new Box3().setFromPoints(points);
    this.controls.target.copy(fitCamera(this.camera, points, { margin: this.canvas.clientWidth < 600 ? 1.3 : 1.18 }));
    const size = box.getSize(new Vector3()).length();
    this.controls.minDistance = 0.05 * size;
    this.controls.maxDistance = 20 * size;
    this.controls.update();
    this.draw();
  }

  private follow(changed: ReadonlySet<keyof State>): void {
    const { state } = this.store;
    const lights: (keyof State)[] = ['light', 'azimuth', 'elevation', 'softness', 'strength', 'color', 'fill', 'environment', 'environmentTurn', 'environmentStrength', 'window', 'bands'];
    if (lights.some((key) => changed.has(key))) this.relight();
    if (changed.has('show') || changed.has('coefficient') || changed.has('technique') || changed.has('compare')) this.look();
    if (changed.has('wireframe')) this.wire();
    if (changed.has('drag')) this.canvas.dataset.drag = state.drag;
    this.draw();
  }

  /** Gives all assets the light that was chosen. */
  relight(): void {
    for (const { asset } of this.shown) applyLight(asset.light, this.store.state, this.environment);
    this.draw();
  }

  private look(): void {
    const { show, technique, coefficient, compare } = this.store.state;
    // Maps that only comparisons show are read when the first of them is wanted.
    const plainWanted = compare || technique !== 'transfer' || show === 'charts' || show === 'normals';
    for (const { asset, plain } of this.shown) {
      asset.showCoefficient(show === 'coefficient' ? Math.min(coefficient, asset.manifest.bands ** 2 - 1) : -1);
      if (!plainWanted) continue;
      const wanted = show === 'charts' || show === 'normals' ? show : technique === 'normal-map' || (technique === 'transfer' && plain.hasNormalMap) ? 'normal-map' : 'phong';
      plain.show(wanted).then(() => this.draw(), this.onerror);
    }
  }

  private wire(): void {
    for (const each of this.shown) {
      if (this.store.state.wireframe && !each.edges) {
        each.edges = new LineSegments(new WireframeGeometry(each.asset.mesh.geometry), new LineBasicMaterial({ color: 0x1f8fff, transparent: true, opacity: 0.55 }));
        each.edges.matrixAutoUpdate = false;
        each.edges.matrixWorld.copy(each.asset.mesh.matrixWorld);
        this.lines.add(each.edges);
      }
      if (each.edges) each.edges.visible = this.store.state.wireframe;
    }
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (width === 0 || height === 0) return;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio || 1, 2));
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    if (!this.touched) this.reframe();
    this.draw();
  }

  /** Draws soon. */
  draw(): void {
    this.frame ||= requestAnimationFrame(() => {
      this.frame = 0;
      this.render();
    });
  }

  /** Draws now. */
  render(): void {
    const { state } = this.store;
    const begin = performance.now();
    // No curve, as kiln-render has none: exposure, a clamp, and the sRGB encoding.
    this.renderer.toneMapping = state.exposure === 0 ? NoToneMapping : LinearToneMapping;
    this.renderer.toneMappingExposure = 2 ** state.exposure;
    this.renderer.setScissorTest(false);
    this.renderer.clear();
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const plainOnly = state.show === 'charts' || state.show === 'normals' || (state.show === 'picture' && state.technique !== 'transfer');
    if (state.compare && state.show === 'picture') {
      const split = Math.round(state.split * width);
      this.renderer.setScissorTest(true);
      this.renderer.setScissor(0, 0, split, height);
      this.renderer.render(this.withTransfer, this.camera);
      this.renderer.setScissor(split, 0, width - split, height);
      this.renderer.render(this.without, this.camera);
      this.renderer.setScissorTest(false);
    } else this.renderer.render(plainOnly ? this.without : this.withTransfer, this.camera);
    if (state.wireframe) this.renderer.render(this.lines, this.camera);
    if (this.shown.length > 0 && this.first) {
      this.first = false;
      performance.mark('kiln-first-picture');
    }
    if (++this.drawn % 4 === 0) this.measure(begin);
    this.moveSun();
    if (this.shown.some(({ asset }) => asset.isUploading)) this.draw();
  }

  /** Measures the time from `begin` to finished pixels, without waiting for them. */
  private measure(begin: number): void {
    const gl = this.renderer.getContext() as WebGL2RenderingContext;
    const sync = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    if (!sync) return;
    gl.flush();
    const poll = () => {
      const status = gl.clientWaitSync(sync, 0, 0);
      if (status === gl.TIMEOUT_EXPIRED && performance.now() - begin < 5000) return void setTimeout(poll, 1);
      gl.deleteSync(sync);
      if (status === gl.ALREADY_SIGNALED || status === gl.CONDITION_SATISFIED) this.ontime(performance.now() - begin);
    };
    setTimeout(poll, 0);
  }

  /** Turns the light. */
  turnLight(azimuth: number, elevation: number): void {
    const { state } = this.store;
    if (state.light === 'none' && state.environment !== 'none') {
      this.store.set({ environmentTurn: wrapped(state.environmentTurn + azimuth) });
      return;
    }
    this.store.set({ azimuth: wrapped(state.azimuth + azimuth), elevation: Math.min(90, Math.max(-90, state.elevation + elevation)) });
  }

  /** Turns the camera around its target. */
  turnView(azimuth: number, elevation: number): void {
    this.touched = true;
    const offset = this.camera.position.clone().sub(this.controls.target);
    const a = Math.atan2(offset.x, offset.z) + (azimuth * Math.PI) / 180;
    const e = Math.min(1.5, Math.max(-1.5, Math.asin(offset.y / offset.length()) + (elevation * Math.PI) / 180));
    this.camera.position.copy(this.controls.target).addScaledVector(new Vector3(Math.cos(e) * Math.sin(a), Math.sin(e), Math.cos(e) * Math.cos(a)), offset.length());
    this.controls.update();
    this.draw();
  }

  zoom(factor: number): void {
    this.touched = true;
    this.camera.position.sub(this.controls.target).multiplyScalar(factor).add(this.controls.target);
    this.controls.update();
    this.draw();
  }

  private readonly startLight = (event: PointerEvent) => {
    const wanted = event.shiftKey || (this.store.state.drag === 'light' && event.isPrimary);
    if (!wanted || event.button !== 0) return;
    event.stopImmediatePropagation();
    event.preventDefault();
    this.canvas.focus({ preventScroll: true });
    this.canvas.setPointerCapture(event.pointerId);
    this.sun.hidden = false;
    let [x, y] = [event.clientX, event.clientY];
    const move = (moved: PointerEvent) => {
      if (moved.pointerId !== event.pointerId) return;
      this.turnLight((moved.clientX - x) * 0.5, (y - moved.clientY) * 0.5);
      [x, y] = [moved.clientX, moved.clientY];
    };
    const end = () => {
      this.canvas.removeEventListener('pointermove', move);
      this.sun.hidden = true;
    };
    this.canvas.addEventListener('pointermove', move);
    this.canvas.addEventListener('lostpointercapture', end, { once: true });
    this.draw();
  };

  /** Puts the sign of the light where it would stand, as seen by the camera. */
  private moveSun(): void {
    if (this.sun.hidden) return;
    const { azimuth, elevation, environmentTurn, light } = this.store.state;
    const direction = new Vector3(...(light === 'none' ? directionOf(70 + environmentTurn, 10) : directionOf(azimuth, elevation)));
    const distance = this.camera.position.distanceTo(this.controls.target);
    const view = direction.clone().transformDirection(this.camera.matrixWorldInverse);
    const at = direction.multiplyScalar(0.2 * distance).add(this.controls.target).project(this.camera);
    this.sun.style.left = `${50 + 50 * Math.max(-0.95, Math.min(0.95, at.x))}%`;
    this.sun.style.top = `${50 - 50 * Math.max(-0.95, Math.min(0.95, at.y))}%`;
    this.sun.classList.toggle('behind', view.z < 0);
  }
}

function wrapped(degrees: number): number {
  return ((((degrees + 180) % 360) + 360) % 360) - 180;
}
