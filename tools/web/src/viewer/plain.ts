// SPDX-License-Identifier: MIT
// An asset's mesh without its transfer: shaded by normals alone, for comparison, or showing normals and charts.
import { type BufferGeometry, DoubleSide, Mesh, ShaderMaterial, type Texture, UniformsLib, UniformsUtils, Vector3 } from 'three';
import * as MikkTSpace from 'three/addons/libs/mikktspace.module.js';
import { computeMikkTSpaceTangents } from 'three/addons/utils/BufferGeometryUtils.js';
import type { KilnAsset } from '../asset';
import { addChartColors } from '../geometry';
import { clampedCosine, HarmonicRotation } from '../harmonics';
import { addLight, noLight } from '../light';
import { pictureTexture } from '../pictures';
import fragmentShader from '../shaders/plain.frag.glsl?raw';
import vertexShader from '../shaders/plain.vert.glsl?raw';

export type PlainLook = 'phong' | 'normal-map' | 'normals' | 'charts';

const mostDirect = 8;

/** Looks at an asset's surface, lit by the asset's own light. */
export class PlainView {
  readonly mesh: Mesh<BufferGeometry, ShaderMaterial>;
  charts = 0;
  private normalMap: Texture | null = null;
  private tangents: Promise<void> | null = null;
  private look: PlainLook = 'phong';

  constructor(readonly asset: KilnAsset) {
    const { albedo, opacity } = asset.textures;
    const defines: Record<string, string> = {};
    if (albedo) defines.KILN_ALBEDO = '';
    if (opacity) defines.KILN_OPACITY = '';
    const vectors = (count: number) => Array.from({ length: count }, () => new Vector3());
    const material = new ShaderMaterial({
      name: 'KilnPlain', vertexShader, fragmentShader, defines, side: DoubleSide, fog: true,
      uniforms: {
        ...UniformsUtils.clone(UniformsLib.fog),
        kiln_albedo: { value: albedo }, kiln_opacity: { value: opacity }, kiln_normals: { value: null },
        kiln_tint: { value: new Vector3(1, 1, 1) }, kiln_irradiance: { value: vectors(9) },
        kiln_towards: { value: vectors(mostDirect) }, kiln_colors: { value: vectors(mostDirect) },
      },
    });
    this.mesh = new Mesh(asset.mesh.geometry.clone(), material);
    this.mesh.matrixAutoUpdate = false;
    this.mesh.onBeforeRender = () => this.update();
  }

  get hasNormalMap(): boolean {
    return this.asset.manifest.normals !== '';
  }

  /** Changes what is shown; resolves when the maps for it are there. */
  async show(look: PlainLook): Promise<void> {
    this.look = look;
    if (look === 'charts' && this.charts === 0) this.charts = addChartColors(this.mesh.geometry);
    if ((look === 'normal-map' || look === 'normals') && this.hasNormalMap) await (this.tangents ??= this.loadNormals());
    if (look !== this.look) return;
    const { defines } = this.mesh.material;
    const normals = (look === 'normal-map' || look === 'normals') && this.normalMap !== null;
    for (const [name, wanted] of [['KILN_NORMALS', normals], ['KILN_TANGENTS', normals && this.inTangentSpace], ['KILN_SHOW_NORMALS', look === 'normals'], ['KILN_CHARTS', look === 'charts']] as const) {
      if (wanted) defines[name] = '';
      else delete defines[name];
    }
    this.mesh.material.needsUpdate = true;
  }

  private get inTangentSpace(): boolean {
    return this.asset.manifest.tangentNormals || this.asset.source.isGltf === true;
  }

  private async loadNormals(): Promise<void> {
    const { manifest, source } = this.asset;
    const file = `${source.name}/${manifest.normals}`;
    this.normalMap = await pictureTexture(await source.bytes(manifest.normals), file, 'data', null);
    this.mesh.material.uniforms.kiln_normals.value = this.normalMap;
    if (!this.inTangentSpace || this.mesh.geometry.attributes.tangent) return;
    await MikkTSpace.ready;
    // The tangents are those of uvs whose v goes up, as the format has them.
    this.mesh.geometry = computeMikkTSpaceTangents(this.mesh.geometry, MikkTSpace, false);
  }

  /** Brings light and place up to date. */
  private update(): void {
    const { asset } = this;
    const { uniforms } = this.mesh.material;
    const turn = rotationRows(asset.mesh.matrixWorld.elements);
    const rest = noLight(3);
    const towards = uniforms.kiln_towards.value as Vector3[];
    const colors = uniforms.kiln_colors.value as Vector3[];
    let direct = 0;
    for (const spec of asset.light.lights) {
      const isDirect = spec.kind === 'directional' || (spec.kind === 'cone' && spec.halfAngle <= 90);
      if (isDirect && direct < mostDirect) {
        const [x, y, z] = spec.direction;
        towards[direct].set(turn[0] * x + turn[1] * y + turn[2] * z, turn[3] * x + turn[4] * y + turn[5] * z, turn[6] * x + turn[7] * y + turn[8] * z);
        colors[direct++].set(...(spec.radiance as [number, number, number]));
      } else addLight(rest, 3, spec, 'none');
    }
    for (; direct < mostDirect; ++direct) colors[direct].set(0, 0, 0);
    const environment = asset.light.environment(3);
    if (environment) addLight(rest, 3, { kind: 'harmonics', coefficients: environment, windowed: false }, 'none');
    const rotation = new HarmonicRotation(3, turn);
    const cosine = clampedCosine(3);
    const channels = rest.map((values) => rotation.apply(values));
    (uniforms.kiln_irradiance.value as Vector3[]).forEach((v, i) => {
      const factor = cosine[Math.floor(Math.sqrt(i))] / Math.PI;
      v.set(channels[0][i] * factor, channels[1][i] * factor, channels[2][i] * factor);
    });
    (uniforms.kiln_tint.value as Vector3).set(...(asset.albedo as [number, number, number]));
    this.mesh.material.uniformsNeedUpdate = true;
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
    (this.normalMap?.image as ImageBitmap | undefined)?.close();
    this.normalMap?.dispose();
  }
}

/** Returns the rotation from world to object space, row by row. */
function rotationRows(e: readonly number[]): number[] {
  return [0, 4, 8].flatMap((k) => {
    const length = Math.hypot(e[k], e[k + 1], e[k + 2]) || 1;
    return [e[k] / length, e[k + 1] / length, e[k + 2] / length];
  });
}
