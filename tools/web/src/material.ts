// SPDX-License-Identifier: MIT
import { type DataArrayTexture, DataTexture, DoubleSide, FloatType, NearestFilter, RGBAFormat, ShaderMaterial, type Texture, UniformsLib, UniformsUtils } from 'three';
import fragmentShader from './shaders/prt.frag.glsl?raw';
import vertexShader from './shaders/prt.vert.glsl?raw';
import { lightWidth } from './weights';

/** What a material reads: planes or the transfer of vertices, and the maps of the surface. */
export interface SurfaceTextures {
  planes: DataArrayTexture | null;
  transfer: DataTexture | null;
  /** The largest number of `transfer`. */
  largest: number;
  clusters: DataTexture | null;
  /** Lookups are blended by the shader, since a texture unit may filter in 8 bits. */
  exact: boolean;
  albedo: Texture | null;
  opacity: Texture | null;
  layers: number;
}

/** Makes the texture of the light, which prt.frag.glsl describes. */
export function makeLightTexture(texels: number): DataTexture {
  const height = Math.ceil(texels / lightWidth);
  const texture = new DataTexture(new Float32Array(4 * lightWidth * height), lightWidth, height, RGBAFormat, FloatType);
  texture.minFilter = texture.magFilter = NearestFilter;
  texture.needsUpdate = true;
  return texture;
}

/** Makes a material that relights. It is lit by `light`, not by three.js; tone mapping and colour space are the renderer's. */
export function makeRelitMaterial(textures: SurfaceTextures, light: DataTexture): ShaderMaterial {
  const defines: Record<string, string> = { KILN_LIGHT_WIDTH: String(lightWidth) };
  if (textures.transfer) defines.KILN_VERTICES = '';
  if (textures.exact) defines.KILN_EXACT = '';
  if (textures.clusters) defines.KILN_CLUSTERS = '';
  if (textures.albedo) defines.KILN_ALBEDO = '';
  if (textures.opacity) defines.KILN_OPACITY = '';
  return new ShaderMaterial({
    name: 'KilnRelit',
    vertexShader,
    fragmentShader,
    defines,
    side: DoubleSide,
    fog: true,
    clipping: true,
    uniforms: {
      ...UniformsUtils.clone(UniformsLib.fog),
      opacity: { value: 1 },
      kiln_planes: { value: textures.planes },
      kiln_transfer: { value: textures.transfer },
      kiln_largest: { value: textures.largest },
      kiln_clusters: { value: textures.clusters },
      kiln_albedo: { value: textures.albedo },
      kiln_opacity: { value: textures.opacity },
      kiln_light: { value: light },
      kiln_layers: { value: textures.layers },
      kiln_gain: { value: 1 },
    },
  });
}
