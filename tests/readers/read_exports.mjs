// SPDX-License-Identifier: MIT
// Reads what `roomscribe export` wrote with programs that are not ours, and holds counts and sizes
// against scene.json: node read_exports.mjs RESULT_FOLDER, where model.ifc and model.glb lie.
import { existsSync, readFileSync } from 'node:fs';
import { join } from 'node:path';

const skipped = 77; // what ctest takes for "not run"
const metre = 1;
const tolerance = 0.001 * metre;

async function load(name) {
    try {
        return await import(name);
    } catch {
        console.log(`skipped: ${name} is not installed; ./dev readers installs it`);
        process.exit(skipped);
    }
}

const failures = [];
function expect(condition, words) {
    if (!condition) failures.push(words);
}
function expectNear(value, wanted, words) {
    expect(Math.abs(value - wanted) <= tolerance, `${words}: ${value} instead of ${wanted}`);
}
function expectSame(value, wanted, words) {
    expect(value === wanted, `${words}: ${value} instead of ${wanted}`);
}

const subtract = (a, b) => a.map((x, i) => x - b[i]);
const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
    a[0] * b[1] - a[1] * b[0]];
const norm = (a) => Math.sqrt(dot(a, a));
const scaled = (a, s) => a.map((x) => x * s);

/** Width along the horizontal and height across it of an upright polygon in the map's frame. */
function sizeOf(polygon, up) {
    let normal = [0, 0, 0];
    for (let i = 1; i + 1 < polygon.length; ++i) {
        normal = cross(subtract(polygon[i], polygon[0]), subtract(polygon[i + 1], polygon[0]))
            .map((x, k) => x + normal[k]);
    }
    normal = scaled(normal, 1 / norm(normal));
    let along = cross(up, normal);
    along = scaled(along, 1 / norm(along));
    const extent = (direction) => {
        const places = polygon.map((corner) => dot(direction, corner));
        return Math.max(...places) - Math.min(...places);
    };
    return { width: extent(along), height: extent(cross(normal, along)) };
}

function values(vector) {
    return Array.from({ length: vector.size() }, (_, i) => vector.get(i));
}

class IfcModel {
    constructor(api, bytes, web) {
        this.api = api;
        this.web = web;
        this.model = api.OpenModel(bytes);
    }
    all(type) {
        return values(this.api.GetLineIDsWithType(this.model, type)).map((id) =>
            this.api.GetLine(this.model, id));
    }
    /** Property and quantity values of every object, by its number. */
    properties() {
        const found = new Map();
        for (const relation of this.all(this.web.IFCRELDEFINESBYPROPERTIES)) {
            const set = this.api.GetLine(this.model, relation.RelatingPropertyDefinition.value);
            const entries = {};
            for (const property of set.HasProperties ?? set.Quantities) {
                const line = this.api.GetLine(this.model, property.value);
                const value = line.NominalValue ?? line.LengthValue ?? line.AreaValue ??
                    line.VolumeValue;
                entries[line.Name.value] = value.value;
            }
            for (const object of relation.RelatedObjects) {
                found.set(object.value, { ...found.get(object.value), ...entries });
            }
        }
        return found;
    }
    /** Volume and bounds of the body, openings cut out, by the triangles that web-ifc makes. */
    body(id) {
        const mesh = this.api.GetFlatMesh(this.model, id);
        let volume = 0;
        const low = [Infinity, Infinity, Infinity];
        const high = [-Infinity, -Infinity, -Infinity];
        for (const part of values(mesh.geometries)) {
            const geometry = this.api.GetGeometry(this.model, part.geometryExpressID);
            const vertices = this.api.GetVertexArray(geometry.GetVertexData(),
                geometry.GetVertexDataSize());
            const indices = this.api.GetIndexArray(geometry.GetIndexData(),
                geometry.GetIndexDataSize());
            const m = part.flatTransformation;
            const corner = (i) => {
                const v = vertices.subarray(6 * i, 6 * i + 3);
                return [0, 1, 2].map((r) =>
                    m[r] * v[0] + m[4 + r] * v[1] + m[8 + r] * v[2] + m[12 + r]);
            };
            for (let i = 0; i < indices.length; i += 3) {
                const [a, b, c] = [0, 1, 2].map((k) => corner(indices[i + k]));
                volume += dot(a, cross(b, c)) / 6;
                for (const p of [a, b, c]) {
                    p.forEach((x, r) => {
                        low[r] = Math.min(low[r], x);
                        high[r] = Math.max(high[r], x);
                    });
                }
            }
        }
        return { volume: Math.abs(volume), low, high };
    }
}

function checkWalls(ifc, properties, byLabel, up) {
    const faces = new Map();
    for (const wall of ifc.all(ifc.web.IFCWALL)) {
        const own = properties.get(wall.expressID);
        for (let i = 1; own[`Face${i}`]; ++i) {
            expect(!faces.has(own[`Face${i}`]), `${own[`Face${i}`]} is a face of two walls`);
            faces.set(own[`Face${i}`], [own[`Face${i}Width`], own[`Face${i}Height`]]);
        }
        if (own.NetVolume === undefined) continue;
        const body = ifc.body(wall.expressID);
        // web-ifc rounds corners to float32; 1 mm of a wall's side is far more.
        const volumeTolerance = 1e-3 * own.Length * own.Height;
        expect(Math.abs(body.volume - own.NetVolume) < volumeTolerance,
            `${wall.Name.value}: body of ${body.volume} m3 instead of ${own.NetVolume}`);
        expectNear(body.high[1] - body.low[1], own.Height, `${wall.Name.value}: height of body`);
    }
    expectSame(faces.size, byLabel('wall').length, 'faces of walls');
    for (const wall of byLabel('wall')) {
        const size = sizeOf(wall.polygon, up);
        expect(faces.has(wall.id), `${wall.id} is a face of no wall`);
        expectNear(faces.get(wall.id)?.[0], size.width, `${wall.id}: width`);
        expectNear(faces.get(wall.id)?.[1], size.height, `${wall.id}: height`);
    }
}

function checkFillings(ifc, type, components, up) {
    const lines = new Map(ifc.all(type).map((line) => [line.Name.value, line]));
    expectSame(lines.size, components.length, `number of ${components[0]?.label ?? 'fillings'}s`);
    for (const component of components) {
        const line = lines.get(component.id);
        const size = sizeOf(component.polygon, up);
        expectNear(line?.OverallWidth.value, size.width, `${component.id}: OverallWidth`);
        expectNear(line?.OverallHeight.value, size.height, `${component.id}: OverallHeight`);
        if (!line) continue;
        const body = ifc.body(line.expressID);
        expectNear(body.high[1] - body.low[1], size.height, `${component.id}: height of body`);
    }
    return lines;
}

function checkOpenings(ifc, fillings) {
    const openings = ifc.all(ifc.web.IFCOPENINGELEMENT).map((line) => line.expressID);
    const walls = new Set(ifc.all(ifc.web.IFCWALL).map((line) => line.expressID));
    const voided = new Map(ifc.all(ifc.web.IFCRELVOIDSELEMENT).map((relation) =>
        [relation.RelatedOpeningElement.value, relation.RelatingBuildingElement.value]));
    const filled = new Map(ifc.all(ifc.web.IFCRELFILLSELEMENT).map((relation) =>
        [relation.RelatedBuildingElement.value, relation.RelatingOpeningElement.value]));
    for (const opening of openings) {
        expect(walls.has(voided.get(opening)), `opening #${opening} voids no wall`);
    }
    for (const [name, line] of fillings) {
        const opening = filled.get(line.expressID);
        expect(openings.includes(opening), `${name} fills no opening`);
    }
}

function checkRooms(ifc, properties, rooms) {
    const spaces = new Map(ifc.all(ifc.web.IFCSPACE).map((line) => [line.Name.value, line]));
    expectSame(spaces.size, rooms.length, 'number of rooms');
    for (const room of rooms) {
        const space = spaces.get(room.id);
        const own = space && properties.get(space.expressID);
        expectNear(own?.NetFloorArea, room.area, `${room.id}: area`);
        expectNear(own?.NetVolume, room.volume, `${room.id}: volume`);
        expectNear(own?.Height, room.ceiling_height - room.floor_height, `${room.id}: height`);
    }
}

async function checkIfc(folder, scene) {
    const web = await load('web-ifc');
    const api = new web.IfcAPI();
    await api.Init();
    api.SetLogLevel(web.LogLevel.LOG_LEVEL_ERROR);
    const ifc = new IfcModel(api, readFileSync(join(folder, 'model.ifc')), web);
    expectSame(api.GetModelSchema(ifc.model), 'IFC4', 'schema');
    const properties = ifc.properties();
    const up = scene.to_room[2].slice(0, 3);
    const byLabel = (label) => scene.components.filter((c) => c.label === label);
    checkWalls(ifc, properties, byLabel, up);
    const doors = checkFillings(ifc, web.IFCDOOR, byLabel('door'), up);
    const windows = checkFillings(ifc, web.IFCWINDOW, byLabel('window'), up);
    checkOpenings(ifc, new Map([...doors, ...windows]));
    checkRooms(ifc, properties, scene.rooms);
    expectSame(ifc.all(web.IFCFURNITURE).length,
        byLabel('furniture').filter((c) => c.box).length, 'pieces of furniture');
    console.log(`model.ifc: ${ifc.all(web.IFCWALL).length} walls of ${byLabel('wall').length} ` +
        `faces, ${doors.size} doors, ${windows.size} windows, ${scene.rooms.length} rooms`);
}

async function checkGlb(folder, scene) {
    const { default: validator } = await load('gltf-validator');
    const bytes = new Uint8Array(readFileSync(join(folder, 'model.glb')));
    const report = await validator.validateBytes(bytes);
    for (const message of report.issues.messages) {
        if (message.severity < 2) expect(false, `${message.pointer}: ${message.message}`);
    }
    const length = new DataView(bytes.buffer).getUint32(12, true);
    const json = JSON.parse(new TextDecoder().decode(bytes.subarray(20, 20 + length)));
    const names = new Set(json.nodes.map((node) => node.name));
    for (const thing of [...scene.rooms, ...scene.components]) {
        if (thing.label === 'unknown') continue; // passages are holes
        expect(names.has(thing.id), `model.glb has no node ${thing.id}`);
    }
    console.log(`model.glb: ${json.nodes.length} nodes, ${report.info.totalTriangleCount} ` +
        `triangles, ${report.issues.numErrors} errors, ${report.issues.numWarnings} warnings`);
}

const folder = process.argv[2];
if (!folder || !existsSync(join(folder, 'scene.json'))) {
    console.error('usage: node read_exports.mjs RESULT_FOLDER');
    process.exit(2);
}
const scene = JSON.parse(readFileSync(join(folder, 'scene.json'), 'utf8'));
await checkIfc(folder, scene);
await checkGlb(folder, scene);
for (const failure of failures) console.error(failure);
process.exit(failures.length === 0 ? 0 : 1);
