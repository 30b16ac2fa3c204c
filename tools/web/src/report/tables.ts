// SPDX-License-Identifier: MIT
// Tables that sort by a click on a column's name.

/** Returns a cell's number, with its unit taken in: "4.2 %", "3.74 MiB", "−0.12", "≤ 60.0 %"; NaN where there is none. */
export function numberIn(text: string): number {
  const match = /([-−]?)\s*([\d.][\d.\s\u202f\u2009]*(?:e[-+−]?\d+)?)\s*([a-zA-Z%°]*)/.exec(text.trim().replace(/^[≤≥±]\s*/, ''));
  if (!match || match.index > 0) return NaN;
  const scale: Record<string, number> = { KiB: 1024, MiB: 1024 ** 2, GiB: 1024 ** 3, ms: 1e-3, µs: 1e-6, min: 60, h: 3600 };
  const value = Number(match[2].replace(/[\s\u202f\u2009]/g, '').replace('−', '-'));
  return (match[1] ? -1 : 1) * value * (scale[match[3]] ?? 1);
}

/** Compares cells: numbers before words, each among themselves. */
export function compareCells(a: string, b: string): number {
  const [x, y] = [numberIn(a), numberIn(b)];
  if (Number.isNaN(x) !== Number.isNaN(y)) return Number.isNaN(x) ? 1 : -1;
  return Number.isNaN(x) ? a.localeCompare(b) : x - y;
}

function sort(table: HTMLTableElement, column: number, descending: boolean): void {
  const body = table.tBodies[0];
  const text = (row: HTMLTableRowElement) => row.cells[column]?.textContent ?? '';
  const rows = [...body.rows].sort((a, b) => (descending ? -1 : 1) * compareCells(text(a), text(b)));
  body.append(...rows);
}

export function mountTables(root: ParentNode): void {
  for (const table of root.querySelectorAll<HTMLTableElement>('table.sortable')) {
    const heads = [...(table.tHead?.rows[0]?.cells ?? [])];
    heads.forEach((head, column) => {
      if (!head.textContent?.trim()) return;
      const button = document.createElement('button');
      button.type = 'button';
      button.className = 'sort';
      button.append(...head.childNodes);
      head.append(button);
      button.addEventListener('click', () => {
        const descending = head.getAttribute('aria-sort') === 'ascending';
        for (const other of heads) other.removeAttribute('aria-sort');
        head.setAttribute('aria-sort', descending ? 'descending' : 'ascending');
        sort(table, column, descending);
      });
    });
  }
}
