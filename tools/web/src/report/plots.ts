// SPDX-License-Identifier: MIT
// Points of plots that say what they are, to a pointer, a finger or the keys.

/** Returns the mark of a plot that lies nearest to a place, within some pixels; null where there is none. */
function markNear(marks: SVGGraphicsElement[], x: number, y: number, within: number): SVGGraphicsElement | null {
  let nearest: SVGGraphicsElement | null = null;
  for (const mark of marks) {
    const box = mark.getBoundingClientRect();
    const distance = Math.hypot(box.x + box.width / 2 - x, box.y + box.height / 2 - y);
    if (distance > within) continue;
    within = distance;
    nearest = mark;
  }
  return nearest;
}

function mount(plot: SVGSVGElement): void {
  const marks = [...plot.querySelectorAll<SVGGraphicsElement>('circle, rect, path, polygon')].filter((mark) => mark.querySelector('title'));
  if (marks.length === 0) return;
  const note = document.createElement('p');
  note.className = 'plot-note on-screen';
  note.hidden = true;
  note.setAttribute('role', 'status');
  plot.after(note);
  const texts = new Map(marks.map((mark) => [mark, mark.querySelector('title')!.textContent ?? '']));
  let shown: SVGGraphicsElement | null = null;
  const show = (mark: SVGGraphicsElement | null) => {
    if (mark === shown) return;
    shown?.classList.remove('is-shown');
    shown = mark;
    note.hidden = mark === null;
    if (!mark) return;
    mark.classList.add('is-shown');
    note.textContent = texts.get(mark)!;
    const box = mark.getBoundingClientRect();
    const around = plot.parentElement!.getBoundingClientRect();
    note.style.left = `${Math.max(0, Math.min(box.x + box.width / 2 - around.x - note.offsetWidth / 2, around.width - note.offsetWidth))}px`;
    note.style.top = `${box.y - around.y - note.offsetHeight - 8}px`;
  };
  // The browser's own notes would come late, and twice.
  for (const mark of marks) {
    mark.querySelector('title')!.remove();
    mark.setAttribute('aria-label', texts.get(mark)!);
    mark.setAttribute('role', 'img');
    mark.tabIndex = 0;
    mark.addEventListener('focus', () => show(mark));
    mark.addEventListener('blur', () => show(null));
  }
  plot.removeAttribute('role');
  plot.parentElement!.style.position = 'relative';
  plot.addEventListener('pointermove', (event) => show(markNear(marks, event.clientX, event.clientY, 32)));
  plot.addEventListener('pointerleave', () => show(null));
}

export function mountPlots(root: ParentNode): void {
  for (const plot of root.querySelectorAll<SVGSVGElement>('svg.tradeoff[viewBox]')) mount(plot);
}
