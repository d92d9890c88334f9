// What is drawn by which viewer under which lights, and how far it may be off. Read by the page too.

export const picture = {width: 160, height: 120};

// packages: from npm. scripts: of node_modules, which the page loads before VIEWER.js. greeting: what it always says.
export const viewers = {
    three: {title: "three.js", packages: ["three@0.187.0"], scripts: []},
    babylon: {
        title: "Babylon.js",
        packages: ["babylonjs@9.28.0", "babylonjs-loaders@9.28.0"],
        scripts: ["babylonjs/babylon.js", "babylonjs-loaders/babylonjs.loaders.min.js"],
        greeting: /^BJS - .* Babylon.js v9.28.0 - WebGL2$/,
    },
    filament: {
        title: "Filament",
        packages: ["filament@1.53.4"],
        scripts: ["filament/filament.js"],
        greeting: /^(FEngine|\[WebKit\]|((Backend |FEngine )?[Ff]eature level))/,
    },
};

// from: where a directional light is. irradiance: on a surface that faces it. sky: radiance from everywhere.
const bend = {eye: [0.12, 0.08, 0.9], target: [0, 0, 0], degrees: 16};
const around = {
    side: {from: [1, 0.4, 1], irradiance: 3},
    front: {from: bend.eye, irradiance: 3},
    behind: {from: [1, 0.2, -0.3], irradiance: 3}, // and grazing
    sky: {sky: 1},
};

// A preset on the bend. most: by viewer, how far the columns may be off, the mean of the directional lights, and the sky;
// absent: as far as they are.
const cloth = (preset, most) => ({
    source: `preset:${preset}`, truth: ["builtin:bend", "--preset", preset], camera: bend, lights: around, most});

// A file, lit from where it is seen, since viewers throw no shadows.
const asset = (file, eye, target, degrees, most) => ({
    source: file, truth: [file, "--profile", "khronos"], camera: {eye, target, degrees},
    lights: {front: {from: eye.map((x, k) => x - target[k]), irradiance: 3}}, most});

export const things = {
    velvet: cloth("velvet", {three: [0.04, 0.15], babylon: [0.03, 0.03], filament: [0.05, 0.05]}),
    denim: cloth("woven-denim", {three: [0.1, 0.05], babylon: [0.1, 0.05], filament: [0.1, 0.1]}),
    gabardine: cloth("woven-gabardine", {three: [0.08, 0.05], babylon: [0.12, 0.06], filament: [0.09, 0.07]}),
    satin: cloth("woven-charmeuse", {three: [0.2, 0.05], babylon: [0.36, 0.4], filament: [0.42, 0.23]}),
    shantung: cloth("woven-shantung"),
    linen: cloth("woven-linen", {three: [0.1, 0.06], babylon: [0.12, 0.15], filament: [0.13, 0.11]}),
    flannel: cloth("woven-wool", {three: [0.1, 0.08], babylon: [0.12, 0.08], filament: [0.12, 0.07]}),
    poplin: cloth("woven-poplin"),
    corduroy: cloth("woven-corduroy"),
    "woven-velvet": cloth("woven-velvet"),
    tartan: cloth("woven-tartan"),
    spheres: asset("spheres.glb", [3, 30, 54], [0, 0.45, 0], 4, {three: [0.04], babylon: [0.04], filament: [0.07]}),
    chair: asset("chair.gltf", [0.2, 0.9, 1.6], [0, 0.4, 0], 40, {three: [0.03], babylon: [0.05], filament: [0.06]}),
};

// What is on a page of docs/, under one of the lights.
export const gallery = {
    light: "side",
    things: ["denim", "satin", "gabardine", "linen", "flannel", "poplin", "corduroy", "woven-velvet", "tartan"]};
