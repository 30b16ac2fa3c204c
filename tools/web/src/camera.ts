// SPDX-License-Identifier: MIT
// The camera of kiln-render: docs/format.md, "From radiance to a picture".
import { Box3, type BufferAttribute, type Object3D, type PerspectiveCamera, Vector3 } from 'three';
import { directionOf } from './harmonics';

export interface FitSettings {
  /** Where the camera stands, degrees: 0 is +Z, the front; 90 is +X. */
  azimuth?: number;
  elevation?: number;
  /** 1 / margin is the part of the picture's tighter side that the silhouette fills. */
  margin?: number;
}

/** Returns the vertices of all meshes beneath an object, in world space. */
export function verticesOf(object: Object3D): Vector3[] {
  const vertices: Vector3[] = [];
  object.updateWorldMatrix(true, true);
  object.traverse((each) => {
    const position = (each as { geometry?: { attributes?: { position?: BufferAttribute } } }).geometry?.attributes?.position;
    if (!position || !('isMesh' in each)) return;
    for (let i = 0; i < position.count; ++i) vertices.push(new Vector3().fromBufferAttribute(position, i).applyMatrix4(each.matrixWorld));
  });
  return vertices;
}

/**
 * Puts a camera as near to an object as its silhouette allows, as kiln-render does; field of view and aspect are the
 * camera's own. Returns the point that it should go around.
 */
export function fitCamera(camera: PerspectiveCamera, object: Object3D | Vector3[], { azimuth = 20, elevation = 12, margin = 1.05 }: FitSettings = {}): Vector3 {
  const vertices = Array.isArray(object) ? object : verticesOf(object);
  if (vertices.length === 0) return new Vector3();
  const outwards = new Vector3(...directionOf(azimuth, Math.min(89.9, Math.max(-89.9, elevation))));
  const forward = outwards.clone().negate();
  const right = new Vector3().crossVectors(forward, new Vector3(0, 1, 0)).normalize();
  const up = new Vector3().crossVectors(right, forward);
  const halfHeight = Math.tan((camera.fov * Math.PI) / 360);
  const slopes = [(halfHeight * camera.aspect) / margin, halfHeight / margin];
  const box = new Box3().setFromPoints(vertices);
  const middle = box.getCenter(new Vector3());
  const low = [Infinity, Infinity];
  const high = [-Infinity, -Infinity];
  const place = new Vector3();
  for (const vertex of vertices) {
    place.copy(vertex).sub(middle);
    const along = place.dot(forward);
    [right, up].forEach((axis, k) => {
      const across = place.dot(axis);
      low[k] = Math.min(low[k], across + slopes[k] * along);
      high[k] = Math.max(high[k], across - slopes[k] * along);
    });
  }
  const size = Math.max(box.getSize(new Vector3()).length(), 1e-24);
  const eyeAlong = Math.min(...[0, 1].map((k) => (low[k] - high[k]) / (2 * slopes[k])), -1e-6 * size);
  const target = middle.addScaledVector(right, (low[0] + high[0]) / 2).addScaledVector(up, (low[1] + high[1]) / 2);
  camera.position.copy(target).addScaledVector(forward, eyeAlong);
  camera.up.set(0, 1, 0);
  camera.near = Math.max(1e-3, -eyeAlong / size - 0.6) * size * 0.5;
  camera.far = (-eyeAlong + 2 * size) * 2;
  camera.lookAt(target);
  camera.updateProjectionMatrix();
  camera.updateMatrixWorld(true);
  return target;
}
