// three.js: viewer(width, height) draws into a texture of floats.
import * as THREE from "three";
import {GLTFLoader} from "three/addons/loaders/GLTFLoader.js";
import {KTX2Loader} from "three/addons/loaders/KTX2Loader.js";

// Makes a loader that reads KTX 2. Its decoder is in the page, since it may not fetch files beside it.
function gltfLoader(renderer) {
    const {js, wasm} = window.basis, bytes = Uint8Array.from(atob(wasm), c => c.charCodeAt(0));
    THREE.Cache.enabled = true;
    THREE.Cache.add("file:basis/basis_transcoder.js", atob(js));
    THREE.Cache.add("file:basis/basis_transcoder.wasm", bytes.buffer);
    return new GLTFLoader().setKTX2Loader(new KTX2Loader().setTranscoderPath("basis/").detectSupport(renderer));
}

// Makes an environment of one colour.
function evenSky(renderer, radiance) {
    const texel = new THREE.DataTexture(new Float32Array([radiance, radiance, radiance, 1]), 1, 1, THREE.RGBAFormat,
        THREE.FloatType, THREE.EquirectangularReflectionMapping);
    texel.needsUpdate = true;
    return new THREE.PMREMGenerator(renderer).fromEquirectangular(texel).texture;
}

export async function viewer(width, height) {
    const renderer = new THREE.WebGLRenderer();
    const loader = gltfLoader(renderer);
    const target = new THREE.WebGLRenderTarget(width, height, {type: THREE.FloatType});
    return async (bytes, view, light) => {
        const camera = new THREE.PerspectiveCamera(view.degrees, width / height, 0.1, 100);
        camera.position.set(...view.eye);
        camera.lookAt(...view.target);
        const scene = new THREE.Scene();
        if (light.sky) scene.environment = evenSky(renderer, light.sky);
        if (light.from) {
            const sun = new THREE.DirectionalLight(0xffffff, light.irradiance);
            sun.position.set(...light.from);
            scene.add(sun);
        }
        scene.add((await loader.parseAsync(bytes, "")).scene);
        renderer.setRenderTarget(target);
        renderer.setClearColor(0, 0);
        renderer.render(scene, camera);
        const pixels = new Float32Array(4 * width * height);
        renderer.readRenderTargetPixels(target, 0, 0, width, height, pixels);
        return pixels;
    };
}
