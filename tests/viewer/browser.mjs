// SPDX-License-Identifier: MIT
// A page in a real browser without a window. Exits with 77 where npm's packages or Chromium are not
// there: the test is then skipped.
import { existsSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const notInstalled = 77;
const packages = join(dirname(fileURLToPath(import.meta.url)), "../../viewer/package.json");

function skip(why) {
  console.log(why);
  process.exit(notInstalled);
}

async function findPuppeteer() {
  try {
    return (await import(createRequire(packages).resolve("puppeteer-core"))).default;
  } catch {
    return skip("puppeteer-core is not installed: ./dev viewer does it");
  }
}

/// A page that keeps every message of its console that is a warning or an error in `complaints`.
export async function openPage(options = {}) {
  const puppeteer = await findPuppeteer();
  const executablePath = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"].find(existsSync);
  if (!executablePath) skip("Chromium is not installed");
  const graphics = options.withoutWebGL ? ["--disable-gpu", "--disable-3d-apis"]
    : ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist"];
  const browser = await puppeteer.launch({ executablePath, headless: true, protocolTimeout: 100_000, args: ["--no-sandbox", ...graphics] });
  const page = await browser.newPage();
  page.setDefaultNavigationTimeout(90_000);  // a busy machine draws the first picture late
  await page.setViewport({ width: 900, height: 620, ...options.viewport });
  await page.emulateMediaFeatures([
    { name: "prefers-reduced-motion", value: "reduce" },
    { name: "prefers-color-scheme", value: options.scheme ?? "light" },
  ]);
  const complaints = [];
  page.on("console", (message) => {
    // Software graphics warn of slow reading back, which only tests do.
    if (["error", "warn", "warning"].includes(message.type()) && !/GPU stall|GL Driver Message/.test(message.text())) complaints.push(message.text());
  });
  page.on("pageerror", (error) => complaints.push(String(error)));
  page.on("request", (request) => {
    if (options.isOffline && /^https?:/.test(request.url())) complaints.push("asks the network for " + request.url());
  });
  return { browser, page, complaints };
}
