// SPDX-License-Identifier: MIT
// Kiln's assets in three.js.
export { KilnAsset } from './asset';
export { fitCamera, type FitSettings } from './camera';
export { KilnAssetElement, defineKilnAsset } from './element';
export { projectPicture, type RadiancePicture } from './environment';
export { KilnError } from './errors';
export { GlbSource } from './glb';
export { directionOf, evaluateBasis, HarmonicRotation } from './harmonics';
export { KilnLight, type LightSpec, type Radiance } from './light';
export { KilnLoader, type LoadProgress } from './loader';
export { readManifest, type Manifest } from './manifest';
export { FilesSource, HttpSource, type AssetSource } from './sources';
export { lightWindows, type LightWindow } from './windows';
