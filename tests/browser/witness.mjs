// The third witness: recorded dispatches again, in a browser.
//
//   node tests/browser/witness.mjs FOLDER
//
// FOLDER holds the dispatches that `TESSIM_RECORD=FOLDER cargo test --release --features gpu --test
// gpu records` wrote, once they had been found equal to the first implementation's results. Needs
// Debian's chromium (or CHROMIUM=path) and the package playwright-core where node finds it. Exit
// codes: 0 all words are equal, 1 some differ, 3 no browser or no adapter.

import { createServer } from "node:http";
import { readdir, readFile } from "node:fs/promises";
import { createRequire } from "node:module";
import path from "node:path";
import { fileURLToPath } from "node:url";

const here = path.dirname(fileURLToPath(import.meta.url));
const folder = process.argv[2];
if (!folder) {
    console.error("witness.mjs: expected the folder of recorded dispatches");
    process.exit(2);
}

async function chromium() {
    try {
        const from = process.env.NODE_PATH ?? process.cwd();
        return createRequire(path.join(from, "_"))("playwright-core").chromium;
    } catch (reason) {
        console.error(`playwright-core: ${reason.message.split("\n")[0]}; npm install playwright-core`);
        process.exit(3);
    }
}

// Localhost counts as secure, which WebGPU asks for.
const server = createServer(async (request, response) => {
    const [, root, name = ""] = request.url.split("/");
    const file = {
        "": path.join(here, "page.html"),
        kernels: path.join(here, "../../src/gpu", path.basename(name)),
        dispatches: path.join(folder, `${path.basename(name)}.json`),
    }[root];
    try {
        const body = await readFile(file);
        response.writeHead(200, { "content-type": root === "" ? "text/html" : "text/plain" });
        response.end(body);
    } catch {
        response.writeHead(404);
        response.end();
    }
});
await new Promise((ready) => server.listen(0, "127.0.0.1", ready));

const count = (await readdir(folder)).filter((name) => /^\d+\.json$/.test(name)).length;
const browser = await (await chromium()).launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: [
        "--no-sandbox",
        "--enable-unsafe-webgpu",
        "--use-webgpu-adapter=swiftshader",
        "--enable-unsafe-swiftshader",
    ],
});
let code = 3;
try {
    const page = await browser.newPage();
    await page.goto(`http://127.0.0.1:${server.address().port}/`);
    const { name, rows } = await page.evaluate((n) => window.witness(n), count);
    console.log(`browser ${browser.version()}, adapter ${name}`);
    const sums = new Map();
    for (const { kernel, values, different, first } of rows) {
        const sum = sums.get(kernel) ?? { dispatches: 0, values: 0, different: 0, first: null };
        sum.dispatches += 1;
        sum.values += values;
        sum.different += different;
        sum.first ??= first;
        sums.set(kernel, sum);
    }
    for (const [kernel, sum] of sums) {
        const found = sum.first ? ` first ${JSON.stringify(sum.first)}` : "";
        const { dispatches, values, different } = sum;
        console.log(`${kernel}: ${dispatches} dispatches, ${values} words, ${different} differ${found}`);
    }
    const wrong = rows.filter((row) => row.different > 0).length;
    code = rows.length > 0 && wrong === 0 ? 0 : 1;
    console.log(`${rows.length} dispatches, ${wrong} differ`);
} catch (reason) {
    console.error(`witness: ${reason.message}`);
} finally {
    await browser.close();
    server.close();
}
process.exit(code);
