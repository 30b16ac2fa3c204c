// SPDX-License-Identifier: MIT
// What scripts add to a report: tables that sort, pictures to look into, points of plots that say what they are, and the
// asset, live. The page is whole without them.
import { mountLive } from './live';
import { mountPictures } from './pictures';
import { mountPlots } from './plots';
import { mountTables } from './tables';

mountTables(document);
mountPictures(document);
mountPlots(document);
mountLive(document);
