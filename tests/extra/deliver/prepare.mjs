// prepare.mjs - what the pages draw and what is compared with it: node prepare.mjs PROGRAM THING ...
//
// Delivers each thing to each viewer, into files.js, and has weft draw THING-LIGHT.npy, the truth. Runs in the folder for
// the files. The page gets the decoder of KTX 2 that three.js ships, too.
import { execFileSync } from 'child_process';
import { readFileSync, writeFileSync } from 'fs';
import { picture, things, viewers } from './table.mjs';

const [program, ...names] = process.argv.slice(2);
const files = Object.fromEntries(Object.keys(viewers).map(viewer => [viewer, {}]));
const weft = parameters => execFileSync(program, parameters, { stdio: ['ignore', 'ignore', 'inherit'] });
const point = numbers => numbers.join(',');
for (const name of names) {
    const thing = things[name], { eye, target, degrees } = thing.camera;
    weft(['deliver', thing.source, '--to', Object.keys(viewers).join(','), '-o', 'files', '--name', name, '--width', '64',
        '--spp', '4']);
    for (const viewer in viewers) files[viewer][name] = readFileSync(`files/${name}-${viewer}.glb`, 'base64');
    for (const [light, { from, irradiance, sky }] of Object.entries(thing.lights))
        weft(['render', ...thing.truth, '--env', `${sky ?? 0}`, '--light', 'none', '--stage', 'none',
            ...from ? ['--light', `sun;${point(from.map(x => -x))};${point([irradiance, irradiance, irradiance])}`] : [],
            '--camera', `${point(eye)};${point(target)};${degrees}`, '--background', 'transparent', '--max-depth', '1',
            '--width', `${picture.width}`, '--height', `${picture.height}`, '--spp', '64', '--quiet',
            '-o', `${name}-${light}.npy`]);
}
const decoder = ending => readFileSync(`node_modules/three/examples/jsm/libs/basis/basis_transcoder.${ending}`, 'base64');
writeFileSync('files.js', `window.files = ${JSON.stringify(files)};
window.basis = ${JSON.stringify({ js: decoder('js'), wasm: decoder('wasm') })};\n`);
