// Makes KTX 2 files and compares texels: node ktx2.mjs make FOLDER writes files of each kind, pictures as .tga, and blocks
// of random bits;
// node ktx2.mjs compare FOLDER has the texels of FILE.ktx2.rgba equal those of three.js' transcoder, bit for bit.
import fs from 'fs'
import path from 'path'
import { createRequire } from 'module'
import { encodeToKTX2 } from 'ktx2-encoder'

const [, , task, folder] = process.argv
const [width, height] = [60, 44]
const RGBA32 = 13

// Returns a random number from 0 to 1, the same in each run.
let state = 12345
const random = () => (state = (Math.imul(state, 1664525) + 1013904223) >>> 0) / 4294967296

const wave = (x, y) => (Math.sin(x * 0.3) * Math.cos(y * 0.2) * 0.5 + 0.5) * 255
const pictures = {
    noise: () => [random() * 256, random() * 256, random() * 256, 255],
    'noise-alpha': () => [random() * 256, random() * 256, random() * 256, random() * 256],
    ramp: (x, y) => [(x * 255) / (width - 1), (y * 255) / (height - 1), ((x + y) * 255) / (width + height - 2), 255],
    'ramp-alpha': (x, y) => [(x * 255) / (width - 1), (y * 255) / (height - 1), 128, 255 - (x * 255) / (width - 1)],
    grey: (x, y) => [wave(x, y), wave(x, y), wave(x, y), 255],
    'grey-alpha': (x, y) => [wave(x, y), wave(x, y), wave(x, y), (x * 7 + y * 3) % 256],
    flat: () => [200, 100, 50, 255],
    normals: (x, y) => {
        const u = 0.4 * Math.sin(x * 0.7), v = 0.4 * Math.cos(y * 0.9)
        return [u * 127.5 + 127.5, v * 127.5 + 127.5, Math.sqrt(1 - u * u - v * v) * 127.5 + 127.5, 255]
    },
    edges: (x, y) => [[250, 20, 30], [10, 200, 90], [20, 40, 240]][((x >> 1) + (y >> 2)) % 3].map(
        v => Math.max(0, Math.min(255, v + random() * 9 - 4))).concat(255),
}

// Returns the bytes of a TGA file of 32 bits a texel, from the top.
function targa(data) {
    const file = Buffer.alloc(18 + data.length)
    file[2] = 2
    file.writeUInt16LE(width, 12)
    file.writeUInt16LE(height, 14)
    file[16] = 32
    file[17] = 0x28
    for (let k = 0; k < data.length; k += 4) file.set([data[k + 2], data[k + 1], data[k], data[k + 3]], 18 + k)
    return file
}

const log = console.log
async function make() {
    for (const [name, color] of Object.entries(pictures)) {
        const data = new Uint8Array(width * height * 4)
        for (let n = 0; n < width * height; n++) data.set(color(n % width, Math.floor(n / width)), 4 * n)
        fs.writeFileSync(path.join(folder, `${name}.tga`), targa(data))
        for (const [kind, options] of Object.entries({
            'uastc-fast': { isUASTC: true, uastcLDRQualityLevel: 0, needSupercompression: false },
            'uastc-zstd': { isUASTC: true, uastcLDRQualityLevel: 3, needSupercompression: true },
            etc1s: { isUASTC: false, qualityLevel: 255 },
            'etc1s-coarse': { isUASTC: false, qualityLevel: 1 },
        })) {
            console.log = () => {} // the encoder tells what it does
            const file = await encodeToKTX2(data, { ...options, isKTX2File: true, generateMipmap: true, isPerceptual: false,
                imageDecoder: async () => ({ width, height, data }) })
            console.log = log
            fs.writeFileSync(path.join(folder, `${name}-${kind}.ktx2`), file)
        }
    }
    // Blocks of random bits, each a file of its own, since a block may have a mode that does not exist.
    const data = new Uint8Array(64).fill(9)
    console.log = () => {}
    const file = await encodeToKTX2(data, { isUASTC: true, isKTX2File: true, needSupercompression: false, imageDecoder: async () => ({ width: 4, height: 4, data }) })
    console.log = log
    const at = Number(new DataView(file.buffer).getBigUint64(80, true))
    for (let k = 0; k < 4000; k++) {
        for (let n = 0; n < 16; n++) file[at + n] = random() * 256
        fs.writeFileSync(path.join(folder, `random-${k}.ktx2`), file)
    }
}

// Returns the texels of all levels as three.js' transcoder has them, or null where it refuses the file.
function transcoded(basis, bytes) {
    const file = new basis.KTX2File(new Uint8Array(bytes))
    try {
        if (!file.isValid() || !file.startTranscoding()) return null
        const levels = []
        for (let level = 0; level < file.getLevels(); level++) {
            const texels = new Uint8Array(file.getImageTranscodedSizeInBytes(level, 0, 0, RGBA32))
            if (!file.transcodeImage(texels, level, 0, 0, RGBA32, 0, -1, -1)) return null
            levels.push(Buffer.from(texels))
        }
        return Buffer.concat(levels)
    } finally {
        file.close()
        file.delete()
    }
}

// Returns the colours of the texels of a block of ETC1 at a place in bytes.
function etc1(bytes, at) {
    const steps = [[2, 8], [5, 17], [9, 29], [13, 42], [18, 60], [24, 80], [33, 106], [47, 183]]
    const differential = bytes[at + 3] & 2, flip = bytes[at + 3] & 1, rows = [bytes[at + 3] >> 5, (bytes[at + 3] >> 2) & 7]
    const five = value => (value << 3) | (value >> 2)
    const bases = [0, 1, 2].map(c => {
        const byte = bytes[at + c], first = byte >> 3, change = (byte & 7) > 3 ? (byte & 7) - 8 : byte & 7
        return differential ? [five(first), five(first + change)] : [(byte >> 4) * 17, (byte & 15) * 17]
    })
    return Array.from({ length: 16 }, (_, t) => {
        const x = t % 4, y = t >> 2, half = flip ? y >> 1 : x >> 1, bit = x * 4 + y
        const negative = (bytes[at + 4 + (bit < 8)] >> bit % 8) & 1, far = (bytes[at + 6 + (bit < 8)] >> bit % 8) & 1
        const step = steps[rows[half]][far] * (negative ? -1 : 1)
        return bases.map(base => Math.max(0, Math.min(255, base[half] + step)))
    })
}

// Returns the ratio of peak to noise, in dB, of the blocks of ETC1 that three.js makes of a file, against its texels.
function etc1Ratio(basis, bytes, texels) {
    const file = new basis.KTX2File(new Uint8Array(bytes)), ETC1 = 0
    file.startTranscoding()
    const blocks = new Uint8Array(file.getImageTranscodedSizeInBytes(0, 0, 0, ETC1))
    file.transcodeImage(blocks, 0, 0, 0, ETC1, 0, -1, -1)
    file.close()
    file.delete()
    let sum = 0
    for (let n = 0; n < width * height; n++) {
        const x = n % width, y = Math.floor(n / width)
        const color = etc1(blocks, 8 * ((y >> 2) * (width / 4) + (x >> 2)))[(y % 4) * 4 + (x % 4)]
        for (let c = 0; c < 3; c++) sum += (color[c] - texels[4 * n + c]) ** 2
    }
    return 10 * Math.log10((255 * 255 * width * height * 3) / Math.max(sum, 1e-9))
}

// Compares hints: weft's may lose 3 dB against those of the encoder from npm, which tries more.
function hintsCompare(basis) {
    let wrong = 0
    for (const name of Object.keys(pictures)) {
        const [mine, theirs] = ['weft', 'uastc-zstd'].map(kind => {
            const bytes = fs.readFileSync(path.join(folder, `${name}-${kind}.ktx2`))
            return etc1Ratio(basis, bytes, transcoded(basis, bytes))
        })
        log(`${name}: as ETC1 ${mine.toFixed(1)} dB, of the encoder from npm ${theirs.toFixed(1)} dB`)
        if (mine < theirs - 3) wrong++
    }
    return wrong
}

async function compare() {
    const libraries = path.resolve('node_modules/three/examples/jsm/libs/basis')
    fs.copyFileSync(path.join(libraries, 'basis_transcoder.js'), 'basis_transcoder.cjs')
    const basis = await createRequire(path.resolve('x.js'))('./basis_transcoder.cjs')(
        { wasmBinary: fs.readFileSync(path.join(libraries, 'basis_transcoder.wasm')), print: () => {}, printErr: () => {} })
    basis.initializeBasis()
    let same = 0, refused = 0, wrong = 0
    for (const name of fs.readdirSync(folder).filter(name => name.endsWith('.ktx2'))) {
        const theirs = transcoded(basis, fs.readFileSync(path.join(folder, name))), ours = path.join(folder, name + '.rgba')
        const mine = fs.existsSync(ours) ? fs.readFileSync(ours) : null
        if (!mine && !theirs) refused++
        else if (mine && theirs && mine.equals(theirs)) same++
        else {
            wrong++
            const at = mine && theirs ? mine.findIndex((byte, k) => byte !== theirs[k]) : -1
            if (wrong < 20) log(`${name}: FAILED: weft ${mine ? mine[at] : 'refuses it'}, three ${theirs ? theirs[at] : 'refuses it'}, byte ${at}`)
        }
    }
    wrong += hintsCompare(basis)
    log(`${same} files decode to the same bits, ${refused} are refused by both, ${wrong} differ`)
    process.exit(wrong || same < 100 ? 1 : 0)
}

await (task === 'make' ? make() : compare())
