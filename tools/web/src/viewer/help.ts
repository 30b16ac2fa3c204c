// SPDX-License-Identifier: MIT
import { button, el } from './elements';

const keys: [string, string][] = [
  ['drag', 'turns the view; with shift the light'],
  ['right drag, two fingers', 'pans'],
  ['wheel, pinch', 'zooms'],
  ['arrows', 'turn the view; with shift the light'],
  ['+ −', 'zoom'],
  ['p', 'the picture'],
  ['d', 'compares with no transfer'],
  ['c', 'charts of the atlas'],
  ['. ,', 'next, previous coefficient of transfer: blue below 0, red above'],
  ['n', 'normals'],
  ['w', 'wireframe'],
  ['l', 'lets a drag move the light'],
  ['r', 'back to the start'],
];

/** The list of keys, which act while the picture has the focus. */
export function helpDialog(): HTMLDialogElement {
  const dialog = el('dialog', { 'aria-label': 'Keys' }, el('h2', {}, 'Keys and pointers'),
    el('dl', {}, ...keys.map(([key, text]) => el('div', {}, el('dt', {}, el('kbd', {}, key)), el('dd', {}, text)))),
    el('p', {}, 'Keys act while the picture has the focus; Tab goes through all controls. Double-click a slider to set it back.'));
  dialog.append(button('Close', () => dialog.close()));
  dialog.addEventListener('click', (event) => {
    if (event.target === dialog) dialog.close();
  });
  return dialog;
}
