// SPDX-License-Identifier: MIT
// report_test.mjs PROGRAM flat: makes up a flat, interprets it, serves it, and checks its report in a browser.
// report_test.mjs PROGRAM real: runs on two scans of a real room, of the folder that ROOMSCRIBE_DATA names, and does the same; what it looks like is not kept, as it changes with what is found in the scans.
import { spawnSync } from "node:child_process";
import { existsSync, mkdtempSync, readdirSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const notInstalled = 77;
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

function interpretFlat(program, out) {
  const flat = join(folder, "flat");
  run(program, "simulate", "flat", "--seed", "3", "--coarseness", "8", "-o", flat);
  const scans = readdirSync(join(flat, "scans")).sort().map((name) => join(flat, "scans", name));
  run(program, "interpret", ...scans, "--poses", join(flat, "truth/poses.txt"), "-o", out);
}

/// False where the scans are not there.
function runOnRealScans(program, out) {
  const room = join(process.env.ROOMSCRIBE_DATA ?? join(here, "../../../shared/data"), "registration/pcl_room_scan");
  const scans = ["room_scan1.pcd", "room_scan2.pcd"].map((name) => join(room, name));
  if (!scans.every((scan) => existsSync(scan))) return false;
  run(program, "run", ...scans, "-o", out);
  return true;
}

try {
  const [program, kind] = process.argv.slice(2);
  const out = join(folder, "out");
  if (!run(program, "version").includes("three.js")) {
    console.log("the program was built without its 3D view: ./dev viewer, then build again");
    process.exitCode = notInstalled;
  } else if (kind === "real") {
    if (runOnRealScans(program, out)) {
      console.log(run(process.execPath, join(here, "check_report.mjs"), out, join(folder, "pictures")));
    } else {
      console.log("registration/pcl_room_scan is not in the folder that ROOMSCRIBE_DATA names");
      process.exitCode = notInstalled;
    }
  } else {
    interpretFlat(program, out);
    console.log(run(process.execPath, join(here, "check_view.mjs"), program, out));
    console.log(run(process.execPath, join(here, "check_report.mjs"), out, join(folder, "pictures"), join(here, "pictures.txt")));
  }
} catch (error) {
  process.exitCode = error.status ?? 1;
} finally {
  rmSync(folder, { recursive: true, force: true });
}
