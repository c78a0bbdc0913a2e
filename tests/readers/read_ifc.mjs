// SPDX-License-Identifier: MIT
// model.ifc, read by web-ifc.
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { cross, dot, Expectations, extent, load, middleOf, planArea, subtract, tolerance } from './expectations.mjs';

/// By how much a hole reaches out of either side of its wall, so that no skin is left.
const voidOverhang = 0.1;

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
    /** Volume and corners of the body, z up, openings cut out, by the triangles that web-ifc makes. */
    body(id) {
        const mesh = this.api.GetFlatMesh(this.model, id);
        let volume = 0;
        const corners = [];
        for (const part of values(mesh.geometries)) {
            const geometry = this.api.GetGeometry(this.model, part.geometryExpressID);
            const vertices = this.api.GetVertexArray(geometry.GetVertexData(),
                geometry.GetVertexDataSize());
            const indices = this.api.GetIndexArray(geometry.GetIndexData(),
                geometry.GetIndexDataSize());
            const m = part.flatTransformation;
            const corner = (i) => {
                const v = vertices.subarray(6 * i, 6 * i + 3);
                const [x, y, z] = [0, 1, 2].map((r) =>
                    m[r] * v[0] + m[4 + r] * v[1] + m[8 + r] * v[2] + m[12 + r]);
                return [x, -z, y]; // web-ifc turns y up
            };
            for (let i = 0; i < indices.length; i += 3) {
                const [a, b, c] = [0, 1, 2].map((k) => corner(indices[i + k]));
                volume += dot(a, cross(b, c)) / 6;
                corners.push(a, b, c);
            }
        }
        return { volume: Math.abs(volume), corners };
    }
}

/** The body of something flat is as wide and high as scene.json says, and stands there. */
function checkPanel(expect, body, wanted, words) {
    expect.near(extent(body.corners, wanted.along), wanted.width, `${words}: width of body`);
    expect.near(extent(body.corners, cross(wanted.normal, wanted.along)), wanted.height, `${words}: height of body`);
    const low = wanted.along.map((_, i) => Math.min(...body.corners.map((p) => p[i])));
    const high = wanted.along.map((_, i) => Math.max(...body.corners.map((p) => p[i])));
    const off = subtract(middleOf([low, high]), wanted.middle);
    expect.near(dot(off, wanted.along), 0, `${words}: place along its wall`);
    expect.near(off[2], 0, `${words}: place in height`);
}

function checkWalls(expect, ifc, properties, walls) {
    const byId = new Map(walls.map((wall) => [wall.id, wall]));
    const seen = [];
    for (const line of ifc.all(ifc.web.IFCWALL)) {
        const name = line.Name.value;
        const own = properties.get(line.expressID);
        const faces = [];
        for (let i = 1; own[`Face${i}`]; ++i) {
            const face = byId.get(own[`Face${i}`]);
            seen.push(own[`Face${i}`]);
            if (!face) continue;
            faces.push(face);
            expect.near(own[`Face${i}Width`], face.width, `${face.id}: width`);
            expect.near(own[`Face${i}Height`], face.height, `${face.id}: height`);
        }
        const opposite = faces.find((face) => dot(face.normal, faces[0].normal) < 0);
        expect.same(own.ThicknessSource === 'measured', opposite !== undefined, `${name}: thickness is measured`);
        if (opposite) {
            const apart = Math.abs(dot(subtract(opposite.middle, faces[0].middle), faces[0].normal));
            expect.near(own.Width, apart, `${name}: thickness`);
        }
        if (own.NetVolume === undefined) continue;
        const body = ifc.body(line.expressID);
        // web-ifc rounds corners to float32; 1 mm of a wall's side is far more.
        expect.near(body.volume, own.NetVolume, `${name}: volume of body`, tolerance * own.Length * own.Height);
        expect.near(extent(body.corners, [0, 0, 1]), own.Height, `${name}: height of body`);
        expect.near(extent(body.corners, faces[0].normal), own.Width, `${name}: thickness of body`);
        expect.near(extent(body.corners, faces[0].along), own.Length, `${name}: length of body`);
    }
    expect.ids(seen, walls, 'faces of walls, each of one');
}

/** Doors or windows: their number, sizes, bodies, and the holes that they fill. */
function checkFillings(expect, ifc, type, fillings, properties) {
    const lines = ifc.all(type);
    expect.ids(lines.map((line) => line.Name.value), fillings, 'doors or windows');
    const voided = new Map(ifc.all(ifc.web.IFCRELVOIDSELEMENT).map((relation) =>
        [relation.RelatedOpeningElement.value, relation.RelatingBuildingElement.value]));
    const filled = new Map(ifc.all(ifc.web.IFCRELFILLSELEMENT).map((relation) =>
        [relation.RelatedBuildingElement.value, relation.RelatingOpeningElement.value]));
    const walls = new Set(ifc.all(ifc.web.IFCWALL).map((line) => line.expressID));
    for (const line of lines) {
        const filling = fillings.find((c) => c.id === line.Name.value);
        if (!filling) continue;
        expect.near(line.OverallWidth.value, filling.width, `${filling.id}: OverallWidth`);
        expect.near(line.OverallHeight.value, filling.height, `${filling.id}: OverallHeight`);
        checkPanel(expect, ifc.body(line.expressID), filling, filling.id);
        const opening = filled.get(line.expressID);
        expect.that(opening !== undefined, `${filling.id} fills no opening`);
        if (opening === undefined) continue;
        const wall = voided.get(opening);
        expect.that(walls.has(wall), `the opening of ${filling.id} voids no wall`);
        const hole = ifc.body(opening);
        checkPanel(expect, hole, filling.frame ?? filling, `opening of ${filling.id}`);
        expect.near(extent(hole.corners, filling.normal), properties.get(wall)?.Width + 2 * voidOverhang,
            `opening of ${filling.id}: depth`);
        const own = properties.get(line.expressID);
        expect.near(own.FrameWidth ?? 0, filling.frame?.width ?? 0, `${filling.id}: width of frame`);
        expect.near(own.FrameHeight ?? 0, filling.frame?.height ?? 0, `${filling.id}: height of frame`);
    }
}

/** What walls lack is what their openings take; of openings that reach beyond their wall, a part. */
function checkHoles(expect, ifc, properties, walls) {
    const taken = new Map();
    for (const relation of ifc.all(ifc.web.IFCRELVOIDSELEMENT)) {
        const wall = relation.RelatingBuildingElement.value;
        const { Width, NetVolume, Face1 } = properties.get(wall);
        const { along } = walls.find((face) => face.id === Face1) ?? {};
        if (NetVolume === undefined || !along) continue;
        const { volume, corners } = ifc.body(relation.RelatedOpeningElement.value);
        const body = ifc.body(wall).corners;
        const isWithin = [along, [0, 0, 1]].every((way) => extent([...body, ...corners], way) - extent(body, way) < tolerance);
        const before = taken.get(wall) ?? { volume: 0, isWithin: true };
        taken.set(wall, { volume: before.volume + volume * Width / (Width + 2 * voidOverhang), isWithin: before.isWithin && isWithin });
    }
    for (const [wall, { volume, isWithin }] of taken) {
        const { Id, GrossVolume, NetVolume, Width, Height } = properties.get(wall);
        const lack = GrossVolume - NetVolume;
        const words = `${Id}: volume of its openings`;
        if (isWithin) expect.near(lack, volume, words, tolerance * Width * Height);
        else expect.that(lack < volume, `${words}: ${lack} is more than ${volume}`);
    }
}

function checkRooms(expect, ifc, properties, rooms) {
    const spaces = ifc.all(ifc.web.IFCSPACE);
    expect.ids(spaces.map((line) => line.Name.value), rooms, 'rooms');
    for (const space of spaces) {
        const room = rooms.find((r) => r.id === space.Name.value);
        if (!room) continue;
        const own = properties.get(space.expressID);
        const height = room.ceiling_height - room.floor_height;
        expect.near(own.NetFloorArea, room.area, `${room.id}: area`);
        expect.near(own.NetVolume, room.volume, `${room.id}: volume`);
        expect.near(own.Height, height, `${room.id}: height`);
        const body = ifc.body(space.expressID);
        expect.near(extent(body.corners, [0, 0, 1]), height, `${room.id}: height of body`);
        for (const [axis, words] of [[[1, 0, 0], 'width'], [[0, 1, 0], 'depth']]) {
            expect.near(extent(body.corners, axis), extent(room.plan, axis.slice(0, 2)), `${room.id}: ${words} of body`);
        }
        expect.near(body.volume, planArea(room.plan) * height, `${room.id}: volume of body`, tolerance * 4 * height);
    }
}

export async function checkIfc(folder, scene) {
    const web = await load('web-ifc');
    const expect = new Expectations('model.ifc');
    const api = new web.IfcAPI();
    await api.Init();
    api.SetLogLevel(web.LogLevel.LOG_LEVEL_ERROR);
    const ifc = new IfcModel(api, readFileSync(join(folder, 'model.ifc')), web);
    expect.same(api.GetModelSchema(ifc.model), 'IFC4', 'schema');
    const properties = ifc.properties();
    checkWalls(expect, ifc, properties, scene.walls);
    checkFillings(expect, ifc, web.IFCDOOR, scene.doors, properties);
    checkFillings(expect, ifc, web.IFCWINDOW, scene.windows, properties);
    checkHoles(expect, ifc, properties, scene.walls);
    checkRooms(expect, ifc, properties, scene.rooms);
    expect.same(ifc.all(web.IFCFURNITURE).length,
        scene.components.filter((c) => c.label === 'furniture' && c.box).length, 'pieces of furniture');
    console.log(`model.ifc: ${ifc.all(web.IFCWALL).length} walls of ${scene.walls.length} ` +
        `faces, ${scene.doors.length} doors, ${scene.windows.length} windows, ${scene.rooms.length} rooms`);
    return expect.failures;
}
