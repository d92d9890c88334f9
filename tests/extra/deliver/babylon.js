// Babylon.js: viewer(width, height) draws into a texture of floats.
const {BABYLON} = window;

// Makes an environment of one colour, and the polynomial of its irradiance as Babylon.js itself computes it.
async function evenSky(scene, radiance) {
    const side = 16, face = new Float32Array(4 * side * side).map((_, k) => k % 4 === 3 ? 1 : radiance);
    const sky = new BABYLON.RawCubeTexture(scene, new Array(6).fill(face), side, BABYLON.Constants.TEXTUREFORMAT_RGBA,
        BABYLON.Constants.TEXTURETYPE_FLOAT, true, false, BABYLON.Texture.TRILINEAR_SAMPLINGMODE);
    sky.gammaSpace = false;
    sky.sphericalPolynomial =
        await BABYLON.CubeMapToSphericalPolynomialTools.ConvertCubeMapTextureToSphericalPolynomial(sky);
    return sky;
}

export async function viewer(width, height) {
    const canvas = Object.assign(document.createElement("canvas"), {width, height}); // whose aspect the camera has
    const engine = new BABYLON.Engine(canvas, false);
    return async (bytes, view, light) => {
        const scene = new BABYLON.Scene(engine);
        scene.useRightHandedSystem = true;
        scene.clearColor = new BABYLON.Color4(0, 0, 0, 0);
        scene.imageProcessingConfiguration.applyByPostProcess = true; // of which there is none: linear
        const camera = new BABYLON.FreeCamera("camera", new BABYLON.Vector3(...view.eye), scene);
        camera.setTarget(new BABYLON.Vector3(...view.target));
        camera.fov = view.degrees * Math.PI / 180;
        camera.minZ = 0.1;
        camera.maxZ = 100;
        if (light.sky) scene.environmentTexture = await evenSky(scene, light.sky);
        if (light.from) {
            const sun = new BABYLON.DirectionalLight("sun", new BABYLON.Vector3(...light.from).scale(-1), scene);
            sun.intensity = light.irradiance;
        }
        await BABYLON.AppendSceneAsync(new Uint8Array(bytes), scene, {pluginExtension: ".glb"});
        const target = new BABYLON.RenderTargetTexture("target", {width, height}, scene, {
            generateMipMaps: false, type: BABYLON.Constants.TEXTURETYPE_FLOAT});
        target.activeCamera = camera;
        target.renderList = scene.meshes;
        target.clearColor = scene.clearColor;
        scene.customRenderTargets.push(target); // so that its shaders are waited for
        await scene.whenReadyAsync(true);
        scene.render();
        const pixels = await target.readPixels();
        scene.dispose();
        return pixels;
    };
}
