// SPDX-License-Identifier: MIT
// Pictures that browsers decode: albedo, opacity and normals.
import { ClampToEdgeWrapping, LinearFilter, LinearMipmapLinearFilter, NoColorSpace, SRGBColorSpace, Texture } from 'three';
import { KilnError } from './errors';

/**
 * Decodes a picture as it stands: no colour profile, alpha apart, first row at the bottom. `size` is what it must be,
 * if that is known. Of 'alpha' the red is the picture's alpha. Rejects with KilnError.
 */
export async function pictureTexture(bytes: Uint8Array, file: string, meaning: 'color' | 'data' | 'alpha', size: { width: number; height: number } | null, mipmaps = false): Promise<Texture> {
  let bitmap;
  try {
    bitmap = await createImageBitmap(new Blob([bytes as Uint8Array<ArrayBuffer>], { type: 'image/png' }), {
      colorSpaceConversion: 'none', premultiplyAlpha: 'none', imageOrientation: 'flipY',
    });
  } catch {
    throw new KilnError(file, 'no picture that a browser reads', 'a sound PNG', 'Copy the folder anew, or run `kiln check` on it.');
  }
  if (size && (bitmap.width !== size.width || bitmap.height !== size.height))
    throw new KilnError(file, `${bitmap.width} x ${bitmap.height} texels`, `${size.width} x ${size.height}`, 'Copy the folder anew, or run `kiln check` on it.');
  if (meaning === 'alpha') {
    const alpha = alphaOf(bitmap);
    bitmap.close();
    bitmap = alpha;
  }
  const texture = new Texture(bitmap);
  texture.flipY = false;
  texture.colorSpace = meaning === 'color' ? SRGBColorSpace : NoColorSpace;
  texture.wrapS = texture.wrapT = ClampToEdgeWrapping;
  texture.generateMipmaps = mipmaps;
  texture.minFilter = mipmaps ? LinearMipmapLinearFilter : LinearFilter;
  texture.magFilter = LinearFilter;
  texture.needsUpdate = true;
  return texture;
}

/** Returns a picture whose colours are the alpha of another. */
function alphaOf(bitmap: ImageBitmap): ImageBitmap {
  const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
  const context = canvas.getContext('2d')!;
  context.fillRect(0, 0, canvas.width, canvas.height);
  // White where the picture is: source-over of white through its alpha.
  const white = new OffscreenCanvas(bitmap.width, bitmap.height);
  const mask = white.getContext('2d')!;
  mask.drawImage(bitmap, 0, 0);
  mask.globalCompositeOperation = 'source-in';
  mask.fillStyle = '#fff';
  mask.fillRect(0, 0, white.width, white.height);
  context.drawImage(white, 0, 0);
  return canvas.transferToImageBitmap();
}
