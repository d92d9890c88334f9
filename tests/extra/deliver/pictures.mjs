// pictures.mjs - what weft and the viewers drew, as arrays of floats: rows from the top, three channels, linear.
import { readFileSync } from 'fs';
import { picture } from './table.mjs';

const { width, height } = picture;

// Copies, since the bytes of a file begin anywhere.
const floats = bytes => new Float32Array(Uint8Array.from(bytes).buffer);

// Returns weft's picture, an .npy, before black.
export function truth(path) {
    const bytes = readFileSync(path), all = floats(bytes.subarray(10 + bytes.readUInt16LE(8)));
    const channels = all.length / (width * height);
    return new Float32Array(3 * width * height).map((_, k) => {
        const at = channels * Math.floor(k / 3);
        return all[at + k % 3] * (channels === 4 ? all[at + 3] : 1);
    });
}

// The browser may say that reading pixels back is slow.
const browsers = /GPU stall due to ReadPixels/;

// Returns what a console said: pictures by "THING LIGHT", and all else of the viewer, a line each.
export function drawn(viewer) {
    const pictures = {}, lines = [];
    for (const [, said] of readFileSync(`${viewer}.log`, 'utf8').matchAll(/CONSOLE[^"]*"([^]*?)", source/g)) {
        const [word, thing, light, base64] = said.split(' ');
        if (word === 'PICTURE') pictures[`${thing} ${light}`] = floats(Buffer.from(base64, 'base64'));
        else if (!browsers.test(said)) lines.push(said);
    }
    return { pictures, lines };
}
