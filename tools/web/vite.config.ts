// SPDX-License-Identifier: MIT
// Builds by mode: the viewer and the report's script, each one file with three.js in it, and the module for programs of
// three.js, the library.
import { readFileSync } from 'node:fs';
import { defineConfig, type Plugin } from 'vite';

/** Imports a file as base64: `import text from 'a.wasm?base64'`. */
function base64(): Plugin {
  return {
    name: 'base64',
    enforce: 'pre',
    async resolveId(id, importer) {
      if (!id.endsWith('?base64')) return null;
      const found = await this.resolve(id.slice(0, -7), importer, { skipSelf: true });
      return found && `\0${found.id}?base64`;
    },
    load(id) {
      if (!id.startsWith('\0') || !id.endsWith('?base64')) return null;
      return `export default ${JSON.stringify(readFileSync(id.slice(1, -7), 'base64'))};`;
    },
  };
}

/** Leaves out the decoders that DRACOLoader would fetch: draco.ts hands out its own. */
function withoutDecoderFiles(): Plugin {
  return {
    name: 'without-decoder-files',
    enforce: 'pre',
    transform(code, id) {
      if (!/DRACOLoader\.js$/.test(id)) return null;
      return code.replace(/new URL\( '[^']*libs\/draco[^']*', import\.meta\.url \)\.toString\(\)/g, "''");
    },
  };
}

/** Takes leading spaces and comments out of shaders. */
function shortShaders(): Plugin {
  return {
    name: 'short-shaders',
    enforce: 'pre',
    load(id) {
      if (!id.endsWith('.glsl?raw')) return null;
      const text = readFileSync(id.slice(0, -4), 'utf8').replace(/\/\/.*$/gm, '').replace(/^\s+/gm, '');
      return `export default ${JSON.stringify(text)};`;
    },
  };
}

const entries: Record<string, { entry: string; file: string }> = {
  library: { entry: 'src/index.ts', file: 'kiln.js' },
  viewer: { entry: 'src/viewer/index.ts', file: 'kiln-viewer.js' },
  report: { entry: 'src/report/index.ts', file: 'kiln-report.js' },
};

export default defineConfig(({ mode }) => ({
  base: './',
  publicDir: false,
  plugins: [base64(), withoutDecoderFiles(), shortShaders()],
  // A page from a file may start workers from classic scripts alone.
  worker: { format: 'iife', plugins: () => [] },
  build: {
    target: 'es2022',
    outDir: 'dist',
    emptyOutDir: false,
    modulePreload: false,
    reportCompressedSize: false,
    chunkSizeWarningLimit: 4096,
    lib: { entry: entries[mode].entry, formats: ['es'], fileName: () => entries[mode].file, cssFileName: 'kiln-viewer' },
    rollupOptions: { external: mode === 'library' ? [/^three$/] : [], output: { inlineDynamicImports: true } },
  },
}));
