// SPDX-License-Identifier: MIT
// report_test.mjs PROGRAM: makes up a flat, interprets it, serves it, and checks its report in a browser.
import { spawnSync } from "node:child_process";
import { mkdtempSync, readdirSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const folder = mkdtempSync(join(tmpdir(), "roomscribe-viewer-"));

function run(...command) {
  const { status, stdout, stderr } = spawnSync(command[0], command.slice(1), { encoding: "utf8" });
  if (status !== 0) {
    console.log(stdout + stderr);
    throw Object.assign(new Error(command.join(" ")), { status });
  }
  return stdout;
}

try {
  const program = process.argv[2];
  if (!run(program, "version").includes("three.js")) {
    console.log("the program was built without its 3D view: ./dev viewer, then build again");
    process.exitCode = 77;
  } else {
    const flat = join(folder, "flat"), out = join(folder, "out");
    run(program, "simulate", "flat", "--seed", "3", "--coarseness", "8", "-o", flat);
    const scans = readdirSync(join(flat, "scans")).sort().map((name) => join(flat, "scans", name));
    run(program, "interpret", ...scans, "--poses", join(flat, "truth/poses.txt"), "-o", out);
    console.log(run(process.execPath, join(here, "check_view.mjs"), program, out));
    console.log(run(process.execPath, join(here, "check_report.mjs"), out, join(folder, "pictures"), join(here, "pictures.txt")));
  }
} catch (error) {
  process.exitCode = error.status ?? 1;
} finally {
  rmSync(folder, { recursive: true, force: true });
}
