// validate.mjs - the Khronos glTF validator over files: node validate.mjs [--strict] FILE...
//
// One line a file; exit 1 where one has an error, or with --strict a warning. Pictures and buffers beside a .gltf are looked
// at too. The validator does not know KHR_texture_basisu: its two warnings of a KTX 2 picture do not count.
// The validator is the npm package gltf-validator, found from the folder the program is started in.
import { createRequire } from 'module';
import { readFileSync } from 'fs';
import { basename, dirname, join, resolve } from 'path';

const validator = createRequire(join(process.cwd(), 'package.json'))('gltf-validator');
const strict = process.argv[2] === '--strict';
const unknown = m => /^\/images\/\d+(\/mimeType)?$/.test(m.pointer) &&
    (m.code === 'IMAGE_UNRECOGNIZED_FORMAT' || m.message.includes("'image/ktx2'"));
let bad = 0;
for (const path of process.argv.slice(strict ? 3 : 2)) {
    const report = await validator.validateBytes(new Uint8Array(readFileSync(path)), {
        uri: basename(path),
        maxIssues: 1000,
        externalResourceFunction: uri => Promise.resolve(
            new Uint8Array(readFileSync(resolve(dirname(path), decodeURIComponent(uri))))),
    });
    const { numErrors, numInfos } = report.issues;
    const messages = report.issues.messages.filter(m => m.severity !== 1 || !unknown(m));
    const numWarnings = messages.filter(m => m.severity === 1).length;
    console.log(`${basename(path)}: ${numErrors} errors, ${numWarnings} warnings, ${numInfos} infos`);
    for (const m of messages.filter(m => m.severity < 2 || process.env.WEFT_VERBOSE).slice(0, 8))
        console.log(`    ${['error', 'warning', 'info', 'hint'][m.severity]} ${m.code} ${m.pointer}: ${m.message}`);
    bad += numErrors + (strict ? numWarnings : 0);
}
process.exit(bad ? 1 : 0);
