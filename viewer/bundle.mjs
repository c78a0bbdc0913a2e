// SPDX-License-Identifier: MIT
// bundle.mjs FILE.cpp: bundles src/main.js with what it imports, as a C++ source that holds the
// bundle as text.
import { readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const folder = dirname(fileURLToPath(import.meta.url));
const { outputFiles } = await build({
  entryPoints: [join(folder, "src/main.js")],
  bundle: true,
  minify: true,
  write: false,
  format: "iife",
  charset: "ascii",
  target: ["chrome100", "firefox115", "safari16.4"],
  loader: { ".css": "text" },
  legalComments: "inline",
});
const { version } = JSON.parse(readFileSync(join(folder, "node_modules/three/package.json")));

// Compilers take literals of limited length; this delimiter stands in no script.
const parts = outputFiles[0].text.match(/[^]{1,16000}/g).map((part) => `R"bundled(${part})bundled"`);
writeFileSync(
  process.argv[2],
  `#include "roomscribe/report/viewer_bundle.hpp"
#include <array>
std::string roomscribe::viewer_script() {
    constexpr std::array<const char*, ${parts.length}> parts{{
${parts.join(",\n")}}};
    std::string script;
    for (const char* part : parts) script += part;
    return script;
}
std::string roomscribe::viewer_libraries() { return "three.js ${version}"; }
`,
);
