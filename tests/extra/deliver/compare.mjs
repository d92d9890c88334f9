// compare.mjs - what viewers drew of delivered files beside weft's truth: node compare.mjs THING ...
//
// VIEWER.log has the pictures, THING-LIGHT.npy is the truth. Prints for each thing and viewer how far the columns are off,
// their differences over their sum; exit 1 where that is more than the table allows, or where a console said anything else.
import { drawn, truth } from './pictures.mjs';
import { picture, things, viewers } from './table.mjs';

// Returns the colours of the columns, means over the height.
function columns(pixels) {
    const { width, height } = picture, sums = new Array(3 * width).fill(0);
    pixels.forEach((value, k) => { sums[k % (3 * width)] += value / height; });
    return sums;
}

let bad = 0;
const pictures = {};
for (const viewer in viewers) {
    const said = drawn(viewer);
    pictures[viewer] = said.pictures;
    for (const line of said.lines.filter(line => line !== 'all done' && !viewers[viewer].greeting?.test(line))) {
        console.log(`${viewer} says: ${line}`);
        bad++;
    }
}
const percent = part => `${(100 * part).toFixed(1)} %`, mean = parts => parts.reduce((a, b) => a + b, 0) / parts.length;
for (const name of process.argv.slice(2))
    for (const viewer in viewers) {
        const thing = things[name], words = [], offs = { lights: [], sky: [] };
        for (const light in thing.lights) {
            const made = columns(pictures[viewer][`${name} ${light}`] ?? [NaN]), reference = columns(truth(`${name}-${light}.npy`));
            let off = 0, all = 0;
            reference.forEach((value, k) => { off += Math.abs(made[k] - value); all += value; });
            offs[thing.lights[light].sky ? 'sky' : 'lights'].push(off / all);
            words.push(`${light} ${percent(off / all)}`);
        }
        const found = Object.values(offs).filter(parts => parts.length).map(mean);
        const most = thing.most?.[viewer] ?? found.map(() => Infinity), good = found.every((part, k) => part <= most[k]);
        console.log(`${name} in ${viewer}: ${words.join(', ')}; mean ${percent(found[0])}`
            + (thing.most ? `, at most ${most.map(percent).join(' and ')}` : '') + (good ? '' : ' FAILED'));
        bad += !good;
    }
process.exit(bad ? 1 : 0);
