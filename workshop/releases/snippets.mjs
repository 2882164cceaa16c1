import { readFileSync, renameSync, writeFileSync } from "node:fs";

globalThis.self ??= globalThis; // older releases were made for browsers
for (const each of JSON.parse(readFileSync("cases.json"))) {
  writeFileSync(`${each.name}.mjs`, each.program);
  try {
    await import(`${process.cwd()}/${each.name}.mjs`);
    renameSync("trajectory.csv", `joint.${each.name}.csv`);
  } catch (error) {
    console.error(String(error));
  }
}
