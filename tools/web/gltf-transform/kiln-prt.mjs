// SPDX-License-Identifier: MIT
// KILN_prt for glTF-Transform (core 4): reads and writes the extension of Kiln's glTF files, so that a file that passes
// through glTF-Transform can still be relit. docs/format.md of Kiln says what it holds.
import { Extension, ExtensionProperty, PropertyType, RefMap, TextureChannel, TextureInfo } from '@gltf-transform/core';

const NAME = 'KILN_prt';
const VERSION = 1;
// A plane is grey: all of it must survive what works on single channels.
const CHANNELS = TextureChannel.R | TextureChannel.G | TextureChannel.B;

/** What relights a material: the manifest, as kiln-bake wrote it, and the pictures or attributes that it names. */
export class Prt extends ExtensionProperty {
  static EXTENSION_NAME = NAME;

  init() {
    this.extensionName = NAME;
    this.propertyType = 'Prt';
    this.parentTypes = [PropertyType.MATERIAL];
  }

  getDefaults() {
    return Object.assign(super.getDefaults(), {
      manifest: {},
      attributes: null,
      pictures: new RefMap(),
      pictureInfos: new RefMap(),
    });
  }

  /** Returns the content of ranges.json or pca.json. */
  getManifest() {
    return this.get('manifest');
  }
  setManifest(manifest) {
    return this.set('manifest', manifest);
  }

  /** Returns the names of vertex attributes by those of the manifest; null for an asset with pictures. */
  getAttributes() {
    return this.get('attributes');
  }
  setAttributes(attributes) {
    return this.set('attributes', attributes);
  }

  /** Returns the names of the pictures, as the manifest has them. */
  listPictures() {
    return this.listRefMapKeys('pictures');
  }
  /** Returns the texture of a picture, null where there is none of that name. */
  getPicture(name) {
    return this.getRefMap('pictures', name);
  }
  /** Sets the texture of a picture, and how it is looked up. */
  setPicture(name, texture, info = new TextureInfo(this.graph)) {
    this.setRefMap('pictures', name, texture, { channels: CHANNELS });
    return this.setRefMap('pictureInfos', name, info);
  }
  getPictureInfo(name) {
    return this.getRefMap('pictureInfos', name);
  }
}

/** The extension, for `io.registerExtensions([KilnPrt])`. */
export class KilnPrt extends Extension {
  static EXTENSION_NAME = NAME;
  extensionName = NAME;

  createPrt() {
    return new Prt(this.document.getGraph());
  }

  read(context) {
    const json = context.jsonDoc.json;
    (json.materials ?? []).forEach((material, index) => {
      const definition = material.extensions?.[NAME];
      if (!definition) return;
      if (definition.version !== VERSION)
        throw new Error(`${NAME}: found version ${definition.version}; expected ${VERSION}; take a newer module`);
      const prt = this.createPrt().setManifest(definition.manifest).setAttributes(definition.attributes ?? null);
      for (const [name, picture] of Object.entries(definition.pictures ?? {})) {
        const info = new TextureInfo(this.document.getGraph());
        prt.setPicture(name, context.textures[json.textures[picture.index].source], info);
        context.setTextureInfo(info, picture);
      }
      context.materials[index].setExtension(NAME, prt);
    });
    return this;
  }

  write(context) {
    for (const material of this.document.getRoot().listMaterials()) {
      const prt = material.getExtension(NAME);
      if (!prt) continue;
      const definition = { version: VERSION, manifest: prt.getManifest() };
      const names = prt.listPictures();
      if (names.length > 0)
        definition.pictures = Object.fromEntries(
          names.map((name) => [name, context.createTextureInfoDef(prt.getPicture(name), prt.getPictureInfo(name))]),
        );
      if (prt.getAttributes()) definition.attributes = prt.getAttributes();
      const target = context.jsonDoc.json.materials[context.materialIndexMap.get(material)];
      target.extensions = { ...target.extensions, [NAME]: definition };
    }
    return this;
  }
}
