// node validate_glb.cjs FILE: Khronos' glTF validator on one file. Prints errors and warnings, then the counts.
const fs = require('fs');
const validator = require('gltf-validator'); // found through NODE_PATH

validator.validateBytes(new Uint8Array(fs.readFileSync(process.argv[2]))).then(({ issues, info }) => {
    for (const { severity, code, message, pointer } of issues.messages)
        if (severity < 2) console.log(`${code} ${pointer}: ${message}`); // hints say which attributes no material uses
    console.log(`${info.totalVertexCount} vertices, ${info.totalTriangleCount} triangles, ` +
        `${issues.numErrors} errors, ${issues.numWarnings} warnings`);
});
