// SPDX-License-Identifier: MIT
// Prints the points of an E57 or LAS file as a program that is not ours reads them, a line of
// x y z red green blue each: node print_points.mjs FILE.
import { readFileSync } from 'node:fs';

const skipped = 77; // what ctest takes for "not run"

async function load(name) {
    try {
        return await import(name);
    } catch {
        console.log(`skipped: ${name} is not installed; ./dev readers installs it`);
        process.exit(skipped);
    }
}

const bytes = new Uint8Array(readFileSync(process.argv[2]));
if (process.argv[2].endsWith('.e57')) {
    const { convertE57 } = await load('web-e57');
    console.log(convertE57(bytes, 'XYZ'));
} else {
    const { Las } = await load('copc');
    const header = Las.Header.parse(bytes.slice(0, Las.Constants.minHeaderLength));
    const begin = header.pointDataOffset;
    const end = begin + header.pointCount * header.pointDataRecordLength;
    const view = Las.View.create(bytes.slice(begin, end), header);
    const columns = ['X', 'Y', 'Z', 'Red', 'Green', 'Blue'].map((name) => view.getter(name));
    for (let i = 0; i < header.pointCount; ++i) console.log(columns.map((of) => of(i)).join(' '));
}
