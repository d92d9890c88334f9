// deliver.mjs - what three.js drew of delivered files beside what weft draws: node deliver.mjs CHROMIUM.LOG NAME=MOST ...
//
// The log has the columns of each file; NAME.npy is weft's picture of the reference. Prints the difference of the columns
// over their sum; exit 1 where it exceeds MOST, or where the console said anything else.
import { readFileSync } from 'fs';

function npyColumns(path) {
    const bytes = readFileSync(path), head = bytes.readUInt16LE(8);
    const [height, width, channels] = bytes.toString('latin1', 10, 10 + head).match(/\((\d+), (\d+), (\d+)\)/)
        .slice(1).map(Number);
    const columns = new Array(3 * width).fill(0);
    for (let y = 0; y < height; y++)
        for (let x = 0; x < width; x++) {
            const at = 10 + head + 4 * channels * (y * width + x);
            const alpha = channels === 4 ? bytes.readFloatLE(at + 12) : 1;
            for (let c = 0; c < 3; c++) columns[3 * x + c] += bytes.readFloatLE(at + 4 * c) * alpha / height;
        }
    return columns;
}

const log = readFileSync(process.argv[2], 'utf8');
const said = [...log.matchAll(/CONSOLE[^"]*"(.*)", source/g)].map(match => match[1]);
let bad = 0;
for (const line of said.filter(line => !line.startsWith('COLUMNS ') && line !== 'all done')) {
    console.log(`the console says: ${line}`);
    bad++;
}
for (const argument of process.argv.slice(3)) {
    const [name, most] = argument.split('=');
    const line = said.find(text => text.startsWith(`COLUMNS ${name} `));
    const drawn = line ? line.split(' ').slice(2).map(Number) : [], reference = npyColumns(`${name}.npy`);
    let off = 0, all = 0;
    reference.forEach((value, k) => { off += Math.abs((drawn[k] ?? NaN) - value); all += value; });
    const good = off / all <= Number(most);
    console.log(`${name}: columns off by ${(100 * off / all).toFixed(1)} %, at most ${100 * most} ${good ? '' : 'FAILED'}`);
    bad += !good;
}
process.exit(bad ? 1 : 0);
