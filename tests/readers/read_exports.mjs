// SPDX-License-Identifier: MIT
// Reads what `roomscribe export` wrote with programs that are not ours, and holds numbers and sizes of walls,
// doors, windows and rooms against scene.json, to 1 mm: node read_exports.mjs RESULT_FOLDER.
import { existsSync } from 'node:fs';
import { join } from 'node:path';
import { readScene } from './expectations.mjs';
import { checkGlb } from './read_gltf.mjs';
import { checkIfc } from './read_ifc.mjs';
import { checkPlans } from './read_plans.mjs';
import { checkGraph, checkSchedules } from './read_tables.mjs';

const folder = process.argv[2];
if (!folder || !existsSync(join(folder, 'scene.json'))) {
    console.error('usage: node read_exports.mjs RESULT_FOLDER');
    process.exit(2);
}
const scene = readScene(folder);
const failures = [];
for (const check of [checkIfc, checkGlb, checkPlans, checkSchedules, checkGraph]) failures.push(...await check(folder, scene));
for (const failure of failures) console.error(failure);
process.exit(failures.length === 0 ? 0 : 1);
