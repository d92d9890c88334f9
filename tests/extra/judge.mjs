// judge.mjs - the files and the pictures of judge.sh.
//
//   node judge.mjs files            writes sheen.gltf and fuzz.gltf, 3 x 2 balls each, and files.js with both for pages
//   node judge.mjs pictures LOG ... writes the floats that pages printed as NAME.npy; exit 1 where a page said more
import { readFileSync, writeFileSync } from 'fs';

const RINGS = 48, SECTORS = 96, ACROSS = SECTORS + 1, BALLS = 6;

function ball() {
    const points = [], tangents = [], uvs = [], index = [];
    for (let k = 0; k < (RINGS + 1) * ACROSS; k++) {
        const theta = Math.PI * Math.floor(k / ACROSS) / RINGS, phi = 2 * Math.PI * (k % ACROSS) / SECTORS;
        points.push(Math.sin(theta) * Math.sin(phi), Math.cos(theta), Math.sin(theta) * Math.cos(phi));
        tangents.push(Math.cos(phi), 0, -Math.sin(phi), 1);
        uvs.push((k % ACROSS) / SECTORS, Math.floor(k / ACROSS) / RINGS);
    }
    for (let ring = 0; ring < RINGS; ring++)
        for (let sector = 0; sector < SECTORS; sector++) {
            const a = ring * ACROSS + sector, b = a + ACROSS;
            if (ring > 0) index.push(a, b, a + 1);
            if (ring < RINGS - 1) index.push(a + 1, b, b + 1);
        }
    const arrays = [new Float32Array(points), new Float32Array(tangents), new Float32Array(uvs), new Uint16Array(index)];
    const bytes = Buffer.concat(arrays.map(a => Buffer.from(a.buffer)));
    let byteOffset = 0;
    const bufferViews = arrays.map(({byteLength}) => {
        const view = {buffer: 0, byteOffset, byteLength};
        byteOffset += byteLength;
        return view;
    });
    const count = (RINGS + 1) * ACROSS;
    return {
        bufferViews,
        accessors: [
            {bufferView: 0, componentType: 5126, count, type: 'VEC3', min: [-1, -1, -1], max: [1, 1, 1]},
            {bufferView: 1, componentType: 5126, count, type: 'VEC4'},
            {bufferView: 2, componentType: 5126, count, type: 'VEC2'},
            {bufferView: 3, componentType: 5123, count: index.length, type: 'SCALAR'}],
        buffers: [{byteLength: bytes.length, uri: 'data:application/octet-stream;base64,' + bytes.toString('base64')}],
    };
}

// Balls of roughness .3, .6 and 1 of the rim from the left, white above and blue below, on one dark base.
function grid(extension, of) {
    const range = [...Array(BALLS).keys()];
    return JSON.stringify({
        asset: {version: '2.0'}, extensionsUsed: [extension], scene: 0, scenes: [{nodes: [...range, BALLS]}],
        cameras: [{type: 'perspective', perspective: {yfov: 0.4, znear: 0.1}}],
        nodes: [...range.map(k => ({mesh: k, translation: [2.4 * (k % 3 - 1), k < 3 ? 1.2 : -1.2, 0]})),
                {camera: 0, translation: [0, 0, 14]}],
        meshes: range.map(k => ({name: `ball-${k}`, primitives: [
            {attributes: {POSITION: 0, NORMAL: 0, TANGENT: 1, TEXCOORD_0: 2}, indices: 3, material: k}]})),
        materials: range.map(k => ({
            name: `cloth-${k}`,
            pbrMetallicRoughness: {metallicFactor: 0, roughnessFactor: 0.9, baseColorFactor: [0.1, 0.05, 0.05, 1]},
            extensions: {[extension]: of([0.3, 0.6, 1][k % 3], k < 3 ? [1, 1, 1] : [0.2, 0.5, 1])}})),
        ...ball(),
    });
}

function files() {
    const made = {
        sheen: grid('KHR_materials_sheen', (r, c) => ({sheenColorFactor: c, sheenRoughnessFactor: r})),
        fuzz: grid('KHR_materials_fuzz', (r, c) => ({fuzzFactor: 1, fuzzColorFactor: c, fuzzRoughnessFactor: r})),
    };
    for (const [name, text] of Object.entries(made)) writeFileSync(`${name}.gltf`, text);
    writeFileSync('files.js', `window.files = ${JSON.stringify(made)};`);
}

function npy(width, rows) {
    const head = `{'descr': '<f4', 'fortran_order': False, 'shape': (${rows.length}, ${width}, 3), }`;
    const padded = head.padEnd(117) + '\n', begin = Buffer.from('\x93NUMPY\x01\x00\x00\x00' + padded, 'latin1');
    begin.writeUInt16LE(padded.length, 8);
    return Buffer.concat([begin, ...rows]);
}

function pictures(logs) {
    let bad = 0;
    for (const log of logs) {
        const said = [...readFileSync(log, 'utf8').matchAll(/CONSOLE[^"]*"(.*)", source/g)].map(match => match[1]);
        const drawn = {};
        for (const line of said) {
            const [word, name, row, base64] = line.split(' ');
            if (word === 'ROW') (drawn[name] ??= [])[Number(row)] = Buffer.from(base64, 'base64');
            else if (line !== 'all done' && !line.startsWith('BJS - ')) {
                console.log(`the console says: ${line}`);
                bad++;
            }
        }
        for (const [name, rows] of Object.entries(drawn)) writeFileSync(`${name}.npy`, npy(rows[0].length / 12, rows));
    }
    process.exit(bad ? 1 : 0);
}

process.argv[2] === 'files' ? files() : pictures(process.argv.slice(3));
