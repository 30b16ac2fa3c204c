// SPDX-License-Identifier: MIT
// What scripts add to a report: tables that sort, pictures to look into, and the asset, live. The page is whole without
// them.
import { mountLive } from './live';
import { mountPictures } from './pictures';
import { mountTables } from './tables';

mountTables(document);
mountPictures(document);
mountLive(document);
