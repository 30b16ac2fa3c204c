// SPDX-License-Identifier: MIT
import { bytesText, button, choice, color, el, select, slider, toggle } from './elements';
import type { Stage } from './stage';
import type { Store } from './state';

const minus = (text: string) => text.replace('-', '−');
const degrees = (value: number) => minus(`${Math.round(value)}°`);

function section(title: string, ...content: (Node | null)[]): HTMLElement {
  return el('section', {}, el('h2', {}, title), ...content);
}

export interface PanelActions {
  openFolder(): void;
  openFile(): void;
  openEnvironment(): void;
  reset(): void;
  help(): void;
  picture(): void;
}

/** The controls beside the picture. */
export function makePanel(store: Store, stage: Stage, actions: PanelActions): { element: HTMLElement; refresh: () => void } {
  const azimuth = slider(store, 'Azimuth', 'azimuth', { min: -180, max: 180, step: 1 }, degrees);
  const elevation = slider(store, 'Elevation', 'elevation', { min: -90, max: 90, step: 1 }, degrees);
  const softness = slider(store, 'Softness', 'softness', { min: 0, max: 90, step: 1 }, degrees);
  const strength = slider(store, 'Strength', 'strength', { min: 0, max: 4, step: 0.01 }, (v) => v.toFixed(2));
  const fill = slider(store, 'Fill', 'fill', { min: 0, max: 1, step: 0.01 }, (v) => v.toFixed(2));
  const tint = color(store, 'Colour', 'color');
  const environment = select(store, 'Surroundings', 'environment', [['none', 'None'], ['overcast', 'Overcast'], ['sunset', 'Sunset'], ['studio', 'Studio'], ['file', 'A file…']]);
  environment.select.addEventListener('change', () => {
    if (environment.select.value === 'file' && !stage.environment) actions.openEnvironment();
  });
  const turn = slider(store, 'Turned by', 'environmentTurn', { min: -180, max: 180, step: 1 }, degrees);
  const environmentStrength = slider(store, 'Their strength', 'environmentStrength', { min: 0, max: 4, step: 0.01 }, (v) => v.toFixed(2));
  const bands = slider(store, 'Bands', 'bands', { min: 1, max: 5, step: 1 }, (v) => (v === 0 ? 'all' : `${v}`));
  const coefficient = slider(store, 'Coefficient', 'coefficient', { min: 0, max: 24, step: 1 }, (v) => {
    const l = Math.floor(Math.sqrt(v));
    return minus(`${v} (${l}, ${v - l * (l + 1)})`);
  });
  const technique = choice(store, 'Shading', 'technique', [['transfer', 'Relit'], ['normal-map', 'Normal map'], ['phong', 'Plain']]);
  const compare = toggle(store, 'Compare with no transfer', 'compare');
  const lights = section('Light',
    choice(store, 'Kind', 'light', [['sun', 'Sun'], ['soft', 'Soft'], ['sky', 'Sky'], ['even', 'Even'], ['none', 'None']]),
    azimuth.row, elevation.row, softness.row, strength.row, tint, fill.row, environment.row, turn.row, environmentStrength.row);
  const fine = section('Harmonics',
    select(store, 'Window', 'window', [['hann', 'Hann'], ['lanczos', 'Lanczos'], ['dering', 'Dering'], ['none', 'None']]).row, bands.row,
    slider(store, 'Exposure', 'exposure', { min: -4, max: 4, step: 0.1 }, (v) => minus(`${v > 0 ? '+' : ''}${v.toFixed(1)}`)).row);
  const view = section('View',
    choice(store, 'Show', 'show', [['picture', 'Picture'], ['charts', 'Charts'], ['coefficient', 'Transfer'], ['normals', 'Normals']]),
    coefficient.row, technique, compare, toggle(store, 'Wireframe', 'wireframe'));
  const tools = el('div', { class: 'tools' },
    button('Reset', actions.reset), button('Save picture', actions.picture), button('Open folder…', actions.openFolder), button('Open file…', actions.openFile), button('Keys', actions.help));
  const element = el('div', { class: 'controls' }, view, lights, fine, tools);

  const show = (row: HTMLElement, wanted: boolean) => (row.hidden = !wanted);
  store.watch(() => {
    const { state } = store;
    const axial = state.light === 'sun' || state.light === 'soft' || state.light === 'sky';
    for (const { row } of [azimuth, elevation]) show(row, axial);
    show(softness.row, state.light === 'soft');
    show(strength.row, state.light !== 'none');
    show(tint, state.light !== 'none');
    show(fill.row, state.light === 'sun' || state.light === 'soft');
    show(turn.row, state.environment !== 'none' && state.environment !== 'overcast');
    show(environmentStrength.row, state.environment !== 'none');
    show(coefficient.row, state.show === 'coefficient');
    show(technique, state.show === 'picture' && !state.compare);
    show(compare, state.show === 'picture');
  });
  const refresh = () => {
    const most = Math.max(1, ...stage.shown.map(({ asset }) => asset.manifest.bands));
    bands.input.max = String(most);
    bands.input.dataset.start = String(most);
    coefficient.input.max = String(most * most - 1);
    store.set({ bands: most, coefficient: Math.min(store.state.coefficient, most * most - 1) });
  };
  return { element, refresh };
}

/** The line of figures beneath the picture. */
export function makeReadout(stage: Stage): { element: HTMLElement; refresh: () => void; time: (milliseconds: number) => void } {
  const values = ['Triangles', 'Read', 'On the GPU', 'Lookups', 'Frame'].map((name) => {
    const value = el('dd', {}, '–');
    return { name, value, pair: el('div', {}, el('dt', {}, name), value) };
  });
  const element = el('dl', { class: 'readout' }, ...values.map(({ pair }) => pair));
  const times: number[] = [];
  const refresh = () => {
    const assets = stage.shown.map(({ asset }) => asset);
    const sum = (of: (asset: (typeof assets)[number]) => number) => assets.reduce((total, asset) => total + of(asset), 0);
    const texts = assets.length === 0 ? [] : [
      sum((asset) => asset.triangles).toLocaleString('en').replaceAll(',', ' '), bytesText(sum((asset) => asset.bytes)),
      bytesText(sum((asset) => asset.gpuBytes)), assets.map((asset) => asset.lookups || '0').join(' · '),
    ];
    values.slice(0, 4).forEach(({ value }, k) => (value.textContent = texts[k] ?? '–'));
    times.length = 0;
  };
  const time = (milliseconds: number) => {
    times.push(milliseconds);
    if (times.length > 12) times.shift();
    const middle = [...times].sort((a, b) => a - b)[times.length >> 1];
    values[4].value.textContent = `${middle.toFixed(middle < 10 ? 1 : 0)} ms`;
  };
  return { element, refresh, time };
}
