// Filament, its build for the web: viewer(width, height) draws into a texture of half floats.
const usage = {COLOR: 1, DEPTH: 2, UPLOADABLE: 8, SAMPLEABLE: 16}; // of filament::backend::TextureUsage

function texture(engine, side, format, uses) {
    const {Texture, Texture$Sampler} = window.Filament;
    return Texture.Builder().width(side[0]).height(side[1]).levels(1).sampler(Texture$Sampler.SAMPLER_2D)
        .format(format).usage(uses).build(engine);
}

// Makes an environment of one colour.
function evenSky(engine, radiance) {
    const {IndirectLight, PixelBuffer, PixelDataFormat, PixelDataType, Texture, Texture$InternalFormat,
        Texture$Sampler} = window.Filament;
    const cube = Texture.Builder().width(1).height(1).levels(1).sampler(Texture$Sampler.SAMPLER_CUBEMAP)
        .format(Texture$InternalFormat.RGBA32F).usage(usage.UPLOADABLE | usage.SAMPLEABLE).build(engine);
    const texels = new Float32Array(4 * 6).map((_, k) => k % 4 === 3 ? 1 : radiance);
    cube.setImageCube(engine, 0, PixelBuffer(texels, PixelDataFormat.RGBA, PixelDataType.FLOAT));
    return IndirectLight.Builder().reflections(cube).irradianceSh(1, [radiance, radiance, radiance]).intensity(1)
        .build(engine);
}

export async function viewer(width, height) {
    await new Promise(ready => window.Filament.init([], ready));
    const {Camera$Fov, Engine, EntityManager, LightManager, LightManager$Type, RenderTarget,
        RenderTarget$AttachmentPoint, Texture$InternalFormat} = window.Filament;
    const canvas = document.createElement("canvas");
    canvas.width = width;
    canvas.height = height;
    const engine = Engine.create(canvas), gl = engine.context;
    gl.getExtension("EXT_color_buffer_float");
    // Which framebuffer it draws into is known to WebGL alone.
    let framebuffer = null;
    const bind = gl.bindFramebuffer;
    gl.bindFramebuffer = (target, which) => {
        if (which) framebuffer = which;
        bind.call(gl, target, which);
    };
    const color = texture(engine, [width, height], Texture$InternalFormat.RGBA16F, usage.COLOR | usage.SAMPLEABLE);
    const depth = texture(engine, [width, height], Texture$InternalFormat.DEPTH32F, usage.DEPTH);
    const target = RenderTarget.Builder().texture(RenderTarget$AttachmentPoint.COLOR, color)
        .texture(RenderTarget$AttachmentPoint.DEPTH, depth).build(engine);
    const renderer = engine.createRenderer(), swapChain = engine.createSwapChain(), seen = engine.createView();
    const camera = engine.createCamera(EntityManager.get().create());
    camera.setExposureDirect(1);
    seen.setCamera(camera);
    seen.setViewport([0, 0, width, height]);
    seen.setPostProcessingEnabled(false); // linear
    seen.setRenderTarget(target);
    renderer.setClearOptions({clearColor: [0, 0, 0, 0], clear: true});
    const loader = engine.createAssetLoader();
    return async (bytes, view, light) => {
        camera.setProjectionFov(view.degrees, width / height, 0.1, 100, Camera$Fov.VERTICAL);
        camera.lookAt(view.eye, view.target, [0, 1, 0]);
        const scene = engine.createScene();
        seen.setScene(scene);
        if (light.sky) scene.setIndirectLight(evenSky(engine, light.sky));
        if (light.from) {
            const sun = EntityManager.get().create();
            LightManager.Builder(LightManager$Type.DIRECTIONAL).color([1, 1, 1]).intensity(light.irradiance)
                .direction(light.from.map(x => -x)).build(engine, sun);
            scene.addEntity(sun);
        }
        const asset = loader.createAsset(new Uint8Array(bytes));
        await new Promise(ready => asset.loadResources(ready));
        scene.addEntities(asset.getEntities());
        for (let frame = 0; frame < 3; frame++) { // shaders are compiled meanwhile
            renderer.render(swapChain, seen);
            engine.execute();
            await new Promise(next => setTimeout(next, 30));
        }
        const pixels = new Float32Array(4 * width * height);
        bind.call(gl, gl.READ_FRAMEBUFFER, framebuffer);
        gl.readPixels(0, 0, width, height, gl.RGBA, gl.FLOAT, pixels);
        return pixels;
    };
}
