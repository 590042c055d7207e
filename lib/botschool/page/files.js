// The run files of botschool, byte by byte as the command writes them.

// Returns an array as numpy's .npy file, of float64 or float32.
function npy(values, shape = [values.length]) {
  const size = values instanceof Float32Array ? 4 : 8;
  const sides = shape.length === 1 ? `${shape[0]},` : shape.join(", ");
  const text = `{'descr': '<f${size}', 'fortran_order': False, 'shape': (${sides}), }`;
  const length = Math.ceil((10 + text.length + 1) / 64) * 64 - 10;
  const head = `\x93NUMPY\x01\x00${String.fromCharCode(length & 255, length >> 8)}${text.padEnd(length - 1)}\n`;
  const file = new Uint8Array(head.length + size * values.length);
  file.set(Uint8Array.from(head, (letter) => letter.charCodeAt(0)));
  const view = new DataView(file.buffer);
  const put = (size === 4 ? view.setFloat32 : view.setFloat64).bind(view);
  values.forEach((value, i) => put(head.length + size * i, value, true));
  return file;
}

// Reads such a file of float64 or float32, row by row.
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

// Returns a number as Python prints a float.
function python(value) {
  if (Number.isInteger(value) && Math.abs(value) < 1e16) return value.toFixed(1);
  const size = Math.abs(value);
  if (size >= 1e-4 && size < 1e16) return String(value);
  const [digits, power] = value.toExponential().split("e");
  return `${digits}e${power[0]}${power.slice(1).padStart(2, "0")}`;
}

// Returns name -> contents of a run's files. kept: with two sides, [generation, individuals, meetings].
function runFiles(seed, { rows, best, bestg, generation, kept = [] }) {
  const [steps, reached, bestgfit] = rows.slice(-6);
  const fit = `seed ${seed} gen ${generation} steps ${steps} bestfit ${python(reached)} bestgfit ${python(bestgfit)}\n`;
  const files = { [`statS${seed}.npy`]: npy(rows) };
  if (best.length) files[`bestS${seed}.npy`] = npy(best);
  files[`bestgS${seed}.npy`] = npy(bestg);
  files[`S${seed}.fit`] = new TextEncoder().encode(fit);
  for (const [number, individuals, meetings] of kept) {
    files[`S${seed}G${number}.npy`] = npy(individuals, [(2 * individuals.length) / bestg.length, bestg.length / 2]);
    const side = Math.sqrt(meetings.length / 2);
    files[`S${seed}FitG${number}.npy`] = npy(meetings, [2 * side, side]);
  }
  return files;
}

// Returns the model files of a training, byte by byte as numpy's savez writes them.
function modelFiles({ best, bestg }) {
  return { "best_model.npz": npz(modelArrays(bestg)), "last_model.npz": npz(modelArrays(best)) };
}

function modelArrays(saved) {
  const arrays = data.parts.map(([name, shape, first]) => {
    const count = shape.reduce((a, b) => a * b, 1);
    return [name, npy(Float32Array.from(saved.subarray(first, first + count)), shape)];
  });
  if (!data.normalized) return arrays;
  const seen = saved.subarray(-2 * data.inputs);
  const named = { mean: seen.slice(0, data.inputs), variance: seen.slice(data.inputs) };
  for (const [name, values] of Object.entries(named)) arrays.push([`${data.scaling}.${name}`, npy(values)]);
  for (const [name, value] of [["clip", 10], ["epsilon", 1e-8]]) {
    arrays.push([`${data.scaling}.${name}`, npy(Float64Array.of(value), [])]);
  }
  return arrays;
}

function crc32(bytes) {
  let crc = -1;
  for (const byte of bytes) {
    crc ^= byte;
    for (let bit = 0; bit < 8; bit++) crc = (crc >>> 1) ^ (crc & 1 ? 0xedb88320 : 0);
  }
  return ~crc >>> 0;
}

// Returns a ZIP file of arrays, not compressed.
function npz(arrays) {
  const parts = [];
  const directory = [];
  let place = 0;
  // numbers of so many bytes each: [bytes, number, bytes, number, ...]
  const packed = (...numbers) => {
    const bytes = [];
    for (let i = 0; i < numbers.length; i += 2) {
      let rest = BigInt(numbers[i + 1]);
      for (let k = 0; k < numbers[i]; k++, rest >>= 8n) bytes.push(Number(rest & 255n));
    }
    return Uint8Array.from(bytes);
  };
  for (const [key, bytes] of arrays) {
    const name = new TextEncoder().encode(`${key}.npy`);
    const [size, crc, none] = [bytes.length, crc32(bytes), 0xffffffff];
    const head = packed(4, 0x04034b50, 2, 45, 2, 0, 2, 0, 2, 0, 2, 33, 4, crc, 4, none, 4, none, 2, name.length, 2, 20);
    const wide = packed(2, 1, 2, 16, 8, size, 8, size);
    directory.push(packed(4, 0x02014b50, 2, 0x032d, 2, 45, 2, 0, 2, 0, 2, 0, 2, 33, 4, crc, 4, size, 4, size,
      2, name.length, 2, 0, 2, 0, 2, 0, 2, 0, 4, 0x1800000, 4, place), name);
    parts.push(head, name, wide, bytes);
    place += head.length + name.length + wide.length + size;
  }
  const length = directory.reduce((sum, { length: own }) => sum + own, 0);
  const end = packed(4, 0x06054b50, 2, 0, 2, 0, 2, arrays.length, 2, arrays.length, 4, length, 4, place, 2, 0);
  const all = [...parts, ...directory, end];
  const file = new Uint8Array(place + length + end.length);
  let at = 0;
  for (const bytes of all) {
    file.set(bytes, at);
    at += bytes.length;
  }
  return file;
}
