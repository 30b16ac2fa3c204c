// SPDX-License-Identifier: MIT
// Pictures that open at any size, and swap in place with those beside them: the asset with its reference.

const closest = 32; // screen pixels to one of the picture

/** The view of one picture among its neighbours. */
class Lightbox {
  private readonly dialog = document.createElement('dialog');
  private readonly picture = document.createElement('img');
  private readonly names = document.createElement('div');
  private readonly frame = document.createElement('div');
  private pictures: HTMLImageElement[] = [];
  private at = 0;
  private scale = 1;
  private x = 0;
  private y = 0;
  private readonly pointers = new Map<number, PointerEvent>();

  constructor() {
    this.dialog.className = 'lightbox';
    this.dialog.setAttribute('aria-label', 'Picture');
    this.frame.className = 'lightbox-frame';
    this.names.className = 'lightbox-names';
    this.names.setAttribute('role', 'group');
    this.names.setAttribute('aria-label', 'Pictures');
    this.picture.draggable = false;
    const close = document.createElement('button');
    close.type = 'button';
    close.className = 'lightbox-close';
    close.textContent = 'Close';
    close.addEventListener('click', () => this.dialog.close());
    this.frame.append(this.picture);
    this.dialog.append(this.frame, this.names, close);
    document.body.append(this.dialog);
    this.dialog.addEventListener('keydown', (event) => this.key(event));
    this.frame.addEventListener('wheel', (event) => this.wheel(event), { passive: false });
    this.frame.addEventListener('pointerdown', (event) => this.press(event));
    this.frame.addEventListener('pointermove', (event) => this.move(event));
    for (const name of ['pointerup', 'pointercancel'] as const) this.frame.addEventListener(name, (event) => this.pointers.delete(event.pointerId));
    this.frame.addEventListener('dblclick', () => this.fit());
    new ResizeObserver(() => this.fit()).observe(this.frame);
  }

  open(pictures: HTMLImageElement[], at: number): void {
    this.pictures = pictures;
    this.names.replaceChildren(
      ...pictures.map((picture, k) => {
        const button = document.createElement('button');
        button.type = 'button';
        button.textContent = picture.closest('figure')?.querySelector('figcaption b')?.textContent ?? picture.alt;
        button.addEventListener('click', () => this.show(k));
        return button;
      }),
    );
    this.names.hidden = pictures.length < 2;
    this.show(at);
    this.dialog.showModal();
    this.fit();
  }

  private show(at: number): void {
    this.at = (at + this.pictures.length) % this.pictures.length;
    const { src, alt } = this.pictures[this.at];
    this.picture.src = src;
    this.picture.alt = alt;
    [...this.names.children].forEach((name, k) => name.setAttribute('aria-pressed', String(k === this.at)));
  }

  private get size(): [number, number] {
    const { width, height, naturalWidth, naturalHeight } = this.pictures[this.at];
    return [naturalWidth || width, naturalHeight || height];
  }

  private fit(): void {
    if (this.pictures.length === 0 || !this.dialog.open) return;
    const [width, height] = this.size;
    this.scale = Math.min(this.frame.clientWidth / width, this.frame.clientHeight / height);
    this.x = (this.frame.clientWidth - this.scale * width) / 2;
    this.y = (this.frame.clientHeight - this.scale * height) / 2;
    this.place();
  }

  private place(): void {
    const [width, height] = this.size;
    this.picture.style.width = `${width}px`;
    this.picture.style.height = `${height}px`;
    this.picture.style.transform = `translate(${this.x}px,${this.y}px) scale(${this.scale})`;
    this.picture.style.imageRendering = this.scale > 2 ? 'pixelated' : 'auto';
  }

  /** Scales about a point of the frame. */
  private zoom(factor: number, x = this.frame.clientWidth / 2, y = this.frame.clientHeight / 2): void {
    const scale = Math.min(closest, Math.max(0.1, this.scale * factor));
    this.x = x - (scale / this.scale) * (x - this.x);
    this.y = y - (scale / this.scale) * (y - this.y);
    this.scale = scale;
    this.place();
  }

  private wheel(event: WheelEvent): void {
    event.preventDefault();
    const box = this.frame.getBoundingClientRect();
    this.zoom(Math.exp(-event.deltaY / (event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 12 : 300)), event.clientX - box.left, event.clientY - box.top);
  }

  private press(event: PointerEvent): void {
    this.frame.setPointerCapture(event.pointerId);
    this.pointers.set(event.pointerId, event);
  }

  private move(event: PointerEvent): void {
    const before = this.pointers.get(event.pointerId);
    if (!before) return;
    const other = [...this.pointers.values()].find((pointer) => pointer.pointerId !== event.pointerId);
    this.pointers.set(event.pointerId, event);
    if (other) {
      const box = this.frame.getBoundingClientRect();
      const length = (pointer: PointerEvent) => Math.hypot(pointer.clientX - other.clientX, pointer.clientY - other.clientY);
      this.zoom(length(event) / Math.max(1, length(before)), (event.clientX + other.clientX) / 2 - box.left, (event.clientY + other.clientY) / 2 - box.top);
    } else {
      this.x += event.clientX - before.clientX;
      this.y += event.clientY - before.clientY;
      this.place();
    }
  }

  private key(event: KeyboardEvent): void {
    const keys: Record<string, () => void> = {
      ArrowRight: () => this.show(this.at + 1),
      ArrowLeft: () => this.show(this.at - 1),
      '+': () => this.zoom(1.25),
      '=': () => this.zoom(1.25),
      '-': () => this.zoom(0.8),
      '0': () => this.fit(),
    };
    const digit = Number(event.key);
    const act = keys[event.key] ?? (digit >= 1 && digit <= this.pictures.length ? () => this.show(digit - 1) : undefined);
    if (!act || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    act();
  }
}

export function mountPictures(root: ParentNode): void {
  let lightbox: Lightbox | null = null;
  const opened = new Set<HTMLImageElement>();
  for (const picture of root.querySelectorAll<HTMLImageElement>('figure img')) {
    const group = picture.closest('.quartet, .trio');
    const pictures = group ? [...group.querySelectorAll<HTMLImageElement>('figure img')] : [picture];
    if (opened.has(picture)) continue;
    pictures.forEach((each, at) => {
      opened.add(each);
      const button = document.createElement('button');
      button.type = 'button';
      button.className = 'look';
      button.setAttribute('aria-label', `${each.alt}: look closer`);
      each.replaceWith(button);
      button.append(each);
      button.addEventListener('click', () => (lightbox ??= new Lightbox()).open(pictures, at));
    });
  }
}
