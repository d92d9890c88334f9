// compare.mjs - what viewers drew of delivered files beside weft's truth: node compare.mjs THING ...
//
// VIEWER.log has the pictures, THING-LIGHT.npy is the truth. Prints for each thing and viewer how far the columns are off,
// their differences over their sum; exit 1 where that is more than the table allows, or where a console said anything else.
import { readFileSync } from 'fs';
import { picture, things, viewers } from './table.mjs';

// Returns the colours of the columns, means over the height, of rows of pixels with channels.
function columns(pixels, channels) {
    const { width, height } = picture, sums = new Array(3 * width).fill(0);
    for (let k = 0; k < width * height; k++) {
        const alpha = channels === 4 ? pixels[4 * k + 3] : 1;
        for (let c = 0; c < 3; c++) sums[3 * (k % width) + c] += pixels[channels * k + c] * alpha / height;
    }
    return sums;
}

// Copies, since the bytes of a file begin anywhere.
const floats = bytes => new Float32Array(Uint8Array.from(bytes).buffer);

function truth(path) {
    const bytes = readFileSync(path), start = 10 + bytes.readUInt16LE(8);
    const pixels = floats(bytes.subarray(start));
    return columns(pixels, pixels.length / (picture.width * picture.height));
}

let bad = 0;
// Returns what the viewer drew by thing and light. Anything else in its console is a fault.
function drawn(viewer) {
    const pictures = {};
    for (const [, said] of readFileSync(`${viewer}.log`, 'utf8').matchAll(/CONSOLE[^"]*"([^]*?)", source/g)) {
        const [word, thing, light, base64] = said.split(' ');
        if (word === 'PICTURE') pictures[`${thing} ${light}`] = columns(floats(Buffer.from(base64, 'base64')), 3);
        else if (said !== 'all done' && !viewers[viewer].greeting?.test(said)) {
            console.log(`${viewer} says: ${said}`);
            bad++;
        }
    }
    return pictures;
}

const pictures = Object.fromEntries(Object.keys(viewers).map(viewer => [viewer, drawn(viewer)]));
const percent = part => `${(100 * part).toFixed(1)} %`, mean = parts => parts.reduce((a, b) => a + b, 0) / parts.length;
for (const name of process.argv.slice(2))
    for (const viewer in viewers) {
        const thing = things[name], words = [], offs = { lights: [], sky: [] };
        for (const light in thing.lights) {
            const made = pictures[viewer][`${name} ${light}`] ?? [], reference = truth(`${name}-${light}.npy`);
            let off = 0, all = 0;
            reference.forEach((value, k) => { off += Math.abs((made[k] ?? NaN) - value); all += value; });
            offs[thing.lights[light].sky ? 'sky' : 'lights'].push(off / all);
            words.push(`${light} ${percent(off / all)}`);
        }
        const found = Object.values(offs).filter(parts => parts.length).map(mean);
        const good = found.every((part, k) => part <= thing.most[viewer][k]);
        console.log(`${name} in ${viewer}: ${words.join(', ')}; at most ${thing.most[viewer].map(percent).join(' and ')}`
            + (good ? '' : ' FAILED'));
        bad += !good;
    }
process.exit(bad ? 1 : 0);
