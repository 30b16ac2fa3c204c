// SPDX-License-Identifier: MIT
// For the program: gltf-transform copy in.glb out.glb --config gltf-transform.config.mjs
import { ALL_EXTENSIONS } from '@gltf-transform/extensions';
import { KilnPrt } from './kiln-prt.mjs';

export default { extensions: [...ALL_EXTENSIONS, KilnPrt] };
