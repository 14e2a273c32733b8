// The suites `memory` and `startup`: the memory that a process takes besides the buffers that it lists, and the time of
// a cold start. The processes are started by whoever calls runSuites().
#include "measure/suite.h"

namespace relief {
namespace {

RenderProcess startProcesses(const SuiteContext& context, const TestScene& scene) {
    if (!context.options.makeRenderProcess)
        fail(Failure::input, "the suites memory and startup need MeasureOptions::makeRenderProcess");
    return context.options.makeRenderProcess(scene);
}

/// Compares a frame of many triangles with the same frame of few, each in a process of its own: how much of the memory
/// that it adds is in the buffers that the process lists.
void measureFrameMemory(SuiteContext& context, const TestScene& scene, const RenderProcess& render, Path path,
                        int rate) {
    const ProcessRun few = render({.path = path, .rate = 1, .edgePixels = {}});
    const ProcessRun many = render({.path = path, .rate = rate, .edgePixels = {}});
    RELIEF_CHECK(many.peakDeviceBytes > 0);
    Row row{.suite = Suite::memory, .scene = scene.name, .method = path == Path::dice ? Method::dicing : Method::grid};
    row.addMeasured(Metric::triangles, double(many.triangleCount));
    row.addMeasured(Metric::surfaceAndMapBytes, double(many.deviceBytes));
    row.addMeasured(Metric::bufferBytes, double(many.peakDeviceBytes));
    row.addMeasured(Metric::bufferBytesAtRate1, double(few.peakDeviceBytes));
    row.addMeasured(Metric::processBytes, double(many.peakBytes));
    row.addMeasured(Metric::processBytesAtRate1, double(few.peakBytes));
    const double grown = double(many.peakBytes) - double(few.peakBytes);
    row.addComputed(Metric::memoryPerBufferByte, (grown + double(few.peakDeviceBytes)) / double(many.peakDeviceBytes));
    context.results.rows.push_back(row);
}

} // namespace

void measureMemory(SuiteContext& context, const TestScene& scene) {
    const RenderProcess render = startProcesses(context, scene);
    const int rate = SceneOnDevice(context.device, scene).chooseRate(context.options.isQuick ? 1e5 : 1e7);
    measureFrameMemory(context, scene, render, Path::dice, rate);
    measureFrameMemory(context, scene, render, Path::grid, rate);
    context.progress.advance();
}

void measureStartup(SuiteContext& context, const TestScene& scene) {
    const RenderProcess render = startProcesses(context, scene);
    const double edgePixels = context.options.isQuick ? 16 : 4;

    // The frame of those processes in this process, drawn once to compile its shaders.
    const SceneOnDevice on(context.device, scene);
    Renderer renderer(context.device, {.width = 1024, .height = 1024});
    RenderOptions options = on.renderOptions(1);
    options.rate.reset();
    options.edgePixels = edgePixels;
    if (!context.device.traits().hasTessellation) options.path = Path::grid;
    renderer.render(on.model, options);

    // Each round takes every time once, so that a slow moment of the machine affects all of them.
    std::vector<double> cold, cached, frame, tables, device, peak;
    for (int round = 0; round < (context.options.isQuick ? 1 : 2); ++round) {
        const ProcessRun run = render({.path = {}, .rate = {}, .edgePixels = edgePixels, .usesShaderCache = false});
        cold.push_back(run.milliseconds);
        peak.push_back(double(run.peakBytes));
        cached.push_back(render({.path = {}, .rate = {}, .edgePixels = edgePixels}).milliseconds);
        device.push_back(measureMilliseconds([&] { const Device another({.name = context.options.device}); }));
        tables.push_back(1e3 * buildSurface(scene.cage, scene.surface).tableSeconds);
        frame.push_back(renderer.render(on.model, options).stats.wallMs);
    }

    Row row{.suite = Suite::startup, .scene = scene.name, .method = Method::reliefRender};
    row.addMeasured(Metric::coldRunTime, cold);
    row.addMeasured(Metric::warmRunTime, cached);
    row.addMeasured(Metric::tableTime, tables);
    row.addMeasured(Metric::deviceOpenTime, device);
    row.addMeasured(Metric::warmFrameTime, frame);
    row.addMeasured(Metric::processBytes, peak);
    row.addComputed(Metric::coldRunPerFrame,
                    (computeSpread(cold).median - computeSpread(tables).median) / computeSpread(frame).median);
    context.results.rows.push_back(row);
    context.progress.advance();
}

} // namespace relief
