// SPDX-License-Identifier: MIT
// Controls of the panel: the browser's own, so that keyboards, fingers and screen readers know them.
import type { State, Store } from './state';

type Child = Node | string | null;

export function el<K extends keyof HTMLElementTagNameMap>(tag: K, attributes: Record<string, string> = {}, ...children: Child[]): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, value);
  for (const child of children) if (child !== null) element.append(child);
  return element;
}

let lastId = 0;

function labelled(label: string, control: HTMLElement, extra: Node | null = null): HTMLElement {
  control.id ||= `control-${++lastId}`;
  return el('div', { class: 'row' }, el('label', { for: control.id }, label), control, extra);
}

type KeysOf<T> = { [K in keyof State]: State[K] extends T ? K : never }[keyof State];

/** A number on a line, with its value beside it. */
export function slider(store: Store, label: string, key: KeysOf<number>, range: { min: number; max: number; step: number }, text: (value: number) => string): { row: HTMLElement; input: HTMLInputElement } {
  const input = el('input', { type: 'range', min: String(range.min), max: String(range.max), step: String(range.step) });
  const output = el('output', {});
  const row = labelled(label, input, output);
  output.setAttribute('for', input.id);
  row.classList.add('slider');
  input.addEventListener('input', () => store.set({ [key]: Number(input.value) }));
  input.addEventListener('dblclick', () => store.set({ [key]: Number(input.dataset.start) }));
  input.dataset.start = String(store.state[key]);
  store.watch((changed) => {
    if (!changed.has(key)) return;
    const value = store.state[key];
    input.value = String(value);
    output.textContent = text(value);
    input.setAttribute('aria-valuetext', text(value));
    const part = (Number(input.value) - Number(input.min)) / (Number(input.max) - Number(input.min) || 1);
    input.style.setProperty('--part', String(part));
  });
  return { row, input };
}

/** One of a few, all in sight. */
export function choice<K extends KeysOf<string>>(store: Store, label: string, key: K, options: readonly (readonly [State[K] & string, string])[]): HTMLElement {
  const name = `choice-${++lastId}`;
  const set = el('fieldset', { class: 'choice' }, el('legend', {}, label));
  const list = set.appendChild(el('div', { class: 'options' }));
  for (const [value, text] of options) {
    const input = el('input', { type: 'radio', name, value });
    input.addEventListener('change', () => store.set({ [key]: value }));
    list.append(el('label', {}, input, el('span', {}, text)));
    store.watch(() => (input.checked = store.state[key] === value));
  }
  return set;
}

/** One of several. */
export function select<K extends KeysOf<string>>(store: Store, label: string, key: K, options: readonly (readonly [State[K] & string, string])[]): { row: HTMLElement; select: HTMLSelectElement } {
  const input = el('select', {}, ...options.map(([value, text]) => el('option', { value }, text)));
  input.addEventListener('change', () => store.set({ [key]: input.value }));
  store.watch(() => (input.value = store.state[key]));
  return { row: labelled(label, input), select: input };
}

export function toggle(store: Store, label: string, key: KeysOf<boolean>): HTMLElement {
  const input = el('input', { type: 'checkbox', role: 'switch' });
  input.addEventListener('change', () => store.set({ [key]: input.checked }));
  store.watch(() => (input.checked = store.state[key]));
  return labelled(label, input);
}

export function color(store: Store, label: string, key: 'color'): HTMLElement {
  const input = el('input', { type: 'color' });
  input.addEventListener('input', () => store.set({ [key]: input.value }));
  store.watch(() => (input.value = store.state[key]));
  return labelled(label, input);
}

export function button(label: string, action: () => void, attributes: Record<string, string> = {}): HTMLButtonElement {
  const element = el('button', { type: 'button', ...attributes }, label);
  element.addEventListener('click', action);
  return element;
}

/** Bytes for people. */
export function bytesText(bytes: number): string {
  if (bytes < 1000) return `${bytes} B`;
  if (bytes < 999_500) return `${(bytes / 1000).toFixed(bytes < 9950 ? 1 : 0)} kB`;
  return `${(bytes / 1e6).toFixed(bytes < 9.95e6 ? 1 : 0)} MB`;
}
