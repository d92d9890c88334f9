// montage.mjs - tiles.js of the gallery in the table: node montage.mjs. A row has weft's picture and those of the viewers,
// so bright that weft's brightest is half of white, cut to the cloth.
import { writeFileSync } from 'fs';
import { drawn, truth } from './pictures.mjs';
import { gallery, picture, viewers } from './table.mjs';

const LEFT = 30, WIDTH = 100;
const encode = x => 255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);

function tile(pixels, white) {
    const bytes = new Uint8Array(3 * WIDTH * picture.height);
    for (let k = 0; k < bytes.length; k++) {
        const y = Math.floor(k / (3 * WIDTH)), x = LEFT + Math.floor(k / 3) % WIDTH;
        bytes[k] = encode(Math.min(Math.max(pixels[3 * (y * picture.width + x) + k % 3] / white, 0), 1));
    }
    return Buffer.from(bytes).toString('base64');
}

const pictures = Object.keys(viewers).map(viewer => drawn(viewer).pictures);
const rows = gallery.things.map(name => {
    const reference = truth(`${name}-${gallery.light}.npy`), sorted = [...reference].sort((a, b) => a - b);
    const white = 2 * sorted[Math.floor(0.995 * sorted.length)];
    return { name, tiles: [reference, ...pictures.map(drawn => drawn[`${name} ${gallery.light}`])]
        .map(pixels => tile(pixels, white)) };
});
writeFileSync('tiles.js', `window.tiles = ${JSON.stringify({ width: WIDTH, height: picture.height,
    titles: ['weft', ...Object.values(viewers).map(viewer => viewer.title)], rows })};\n`);
