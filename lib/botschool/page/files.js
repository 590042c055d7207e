// The run files of botschool, byte by byte as the command writes them.

// An array of float64 as numpy's .npy file; of two dimensions if it has columns.
function npy(values, columns = 0) {
  const shape = columns ? `${values.length / columns}, ${columns}` : `${values.length},`;
  const text = `{'descr': '<f8', 'fortran_order': False, 'shape': (${shape}), }`;
  const length = Math.ceil((10 + text.length + 1) / 64) * 64 - 10;
  const head = `\x93NUMPY\x01\x00${String.fromCharCode(length & 255, length >> 8)}${text.padEnd(length - 1)}\n`;
  const file = new Uint8Array(head.length + 8 * values.length);
  file.set(Uint8Array.from(head, (letter) => letter.charCodeAt(0)));
  const view = new DataView(file.buffer);
  values.forEach((value, i) => view.setFloat64(head.length + 8 * i, value, true));
  return file;
}

// The reverse, for files of float64 and float32, row by row.
function fromNpy(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const letters = (first, count) => String.fromCharCode(...bytes.subarray(first, first + count));
  if (bytes.length < 12 || letters(0, 6) !== "\x93NUMPY") throw new Error("this is no .npy file");
  const wide = bytes[6] > 1;
  const length = wide ? view.getUint32(8, true) : view.getUint16(8, true);
  const start = (wide ? 12 : 10) + length;
  const type = /'descr': '<f([48])'/.exec(letters(wide ? 12 : 10, length));
  if (!type) throw new Error("it holds no numbers of type float64 or float32");
  const size = +type[1];
  const count = Math.floor((bytes.length - start) / size);
  return Float64Array.from({ length: count }, (_, i) =>
    size === 8 ? view.getFloat64(start + 8 * i, true) : view.getFloat32(start + 4 * i, true));
}

// A number as Python prints a float.
function python(value) {
  if (Number.isInteger(value) && Math.abs(value) < 1e16) return value.toFixed(1);
  const size = Math.abs(value);
  if (size >= 1e-4 && size < 1e16) return String(value);
  const [digits, power] = value.toExponential().split("e");
  return `${digits}e${power[0]}${power.slice(1).padStart(2, "0")}`;
}

// Name -> contents of the files of a run. kept: of two sides, [generation, individuals, meetings].
function runFiles(seed, { rows, best, bestg, generation, kept = [] }) {
  const [steps, reached, bestgfit] = rows.slice(-6);
  const fit = `seed ${seed} gen ${generation} steps ${steps} bestfit ${python(reached)} bestgfit ${python(bestgfit)}\n`;
  const files = { [`statS${seed}.npy`]: npy(rows) };
  if (best.length) files[`bestS${seed}.npy`] = npy(best);
  files[`bestgS${seed}.npy`] = npy(bestg);
  files[`S${seed}.fit`] = new TextEncoder().encode(fit);
  for (const [number, individuals, meetings] of kept) {
    files[`S${seed}G${number}.npy`] = npy(individuals, bestg.length / 2);
    files[`S${seed}FitG${number}.npy`] = npy(meetings, Math.sqrt(meetings.length / 2));
  }
  return files;
}
