// Prints one JSON object a file: the Khronos validator's counts, and its messages down to warnings.
import { readFile } from "node:fs/promises";
import validator from "gltf-validator";

for (const path of process.argv.slice(2)) {
  const { issues } = await validator.validateBytes(new Uint8Array(await readFile(path)), { maxIssues: 1000 });
  const { numErrors, numWarnings, numInfos, numHints, messages } = issues;
  const grave = messages.filter((message) => message.severity <= 1).map(({ code, pointer, message }) => ({ code, pointer, message }));
  console.log(JSON.stringify({ path, numErrors, numWarnings, numInfos, numHints, grave }));
}
