// What figures draw with: axes, curves and landscapes, labels, handles and arrows.

// Axes in a figure's picture. x, y: [low, high]; box: left, top, width, height in pixels, with room for
// labels at the left and below.
class Plot {
  static grounds = new Map();

  constructor(figure, { x, y, box, labels = ["", ""], ticks = [5, 4], show = String }) {
    const [left, top, width, height] = box ?? [0, 0, figure.width, figure.height];
    this.pen = figure.pen;
    this.range = [x, y];
    this.box = [left + 46, top + 10, width - 58, height - (labels[0] ? 50 : 34)];
    Object.assign(this, { labels, ticks, format: show });
  }

  x(value) { const [[low, high], [left, , width]] = [this.range[0], this.box]; return left + ((value - low) / (high - low)) * width; }
  y(value) { const [[low, high], [, top, , height]] = [this.range[1], this.box]; return top + height - ((value - low) / (high - low)) * height; }
  // Returns the values at a place in the picture.
  at(px, py) {
    const [[x0, x1], [y0, y1]] = this.range;
    const [left, top, width, height] = this.box;
    return [x0 + ((px - left) / width) * (x1 - x0), y1 - ((py - top) / height) * (y1 - y0)];
  }
  inside(px, py) {
    const [left, top, width, height] = this.box;
    return px >= left && px <= left + width && py >= top && py <= top + height;
  }

  axes() {
    const { pen, box: [left, top, width, height], range } = this;
    pen.globalAlpha = 1;
    pen.lineWidth = 1;
    pen.font = "12px system-ui, sans-serif";
    const step = ([low, high], count) => {
      const rough = (high - low) / count;
      const power = 10 ** Math.floor(Math.log10(rough));
      return power * [1, 2, 5, 10].find((each) => each * power >= rough);
    };
    range.forEach(([low, high], axis) => {
      const size = step([low, high], this.ticks[axis]);
      for (let value = Math.ceil(low / size - 1e-9) * size; value <= high + 1e-9 * size; value += size) {
        const shown = this.format(+value.toPrecision(10), axis);
        pen.strokeStyle = colour("line");
        pen.fillStyle = colour("muted");
        pen.beginPath();
        if (axis) {
          pen.moveTo(left, this.y(value)); pen.lineTo(left + width, this.y(value));
          pen.textAlign = "right"; pen.textBaseline = "middle";
          pen.fillText(shown.replace("-", "−"), left - 6, this.y(value));
        } else {
          pen.moveTo(this.x(value), top); pen.lineTo(this.x(value), top + height);
          pen.textAlign = "center"; pen.textBaseline = "top";
          pen.fillText(shown.replace("-", "−"), this.x(value), top + height + 6);
        }
        pen.stroke();
      }
    });
    pen.fillStyle = colour("muted");
    pen.textAlign = "center";
    pen.textBaseline = "bottom";
    if (this.labels[0]) pen.fillText(this.labels[0], left + width / 2, top + height + 38);
    if (this.labels[1]) {
      pen.save();
      pen.translate(left - 34, top + height / 2);
      pen.rotate(-Math.PI / 2);
      pen.textBaseline = "middle";
      pen.fillText(this.labels[1], 0, 0);
      pen.restore();
    }
    return this;
  }

  // Draws a landscape of heights from 0 to 1: the higher, the fuller the colour. key: says what the
  // heights depend on; an equal landscape is not computed again.
  ground(height, name, key, bands = 12) {
    const [left, top, width, high] = this.box;
    const [[[x0, x1], [y0, y1]], size, shade] = [this.range, 240, colour(name)];
    const wanted = JSON.stringify([key, this.range, shade, bands]);
    if (Plot.grounds.get(name)?.wanted !== wanted) {
      const sheet = document.createElement("canvas");
      sheet.width = sheet.height = size;
      const pen = sheet.getContext("2d");
      const image = pen.createImageData(size, size);
      const parts = [1, 3, 5].map((at) => parseInt(shade.slice(at, at + 2), 16));
      for (let i = 0; i < size * size; i++) {
        const value = height(x0 + (((i % size) + 0.5) / size) * (x1 - x0), y1 - ((Math.floor(i / size) + 0.5) / size) * (y1 - y0));
        for (let k = 0; k < 3; k++) image.data[4 * i + k] = parts[k];
        image.data[4 * i + 3] = 12 + 200 * (Math.floor(between(value, 0, 1) * bands) / bands);
      }
      pen.putImageData(image, 0, 0);
      Plot.grounds.set(name, { wanted, sheet });
    }
    this.pen.drawImage(Plot.grounds.get(name).sheet, left, top, width, high);
    return this;
  }

  // Draws only inside the axes.
  clipped(action) {
    this.pen.save();
    this.pen.beginPath();
    this.pen.rect(...this.box);
    this.pen.clip();
    action();
    this.pen.restore();
  }

  line(points, name, width = 2, opacity = 1) {
    const { pen } = this;
    pen.globalAlpha = opacity;
    pen.strokeStyle = colour(name);
    pen.lineWidth = width;
    pen.lineJoin = "round";
    pen.beginPath();
    points.forEach(([x, y], i) => pen[i ? "lineTo" : "moveTo"](this.x(x), this.y(y)));
    pen.stroke();
    pen.globalAlpha = 1;
    return this;
  }

  dots(points, name, radius = 4, opacity = 1) {
    const { pen } = this;
    pen.globalAlpha = opacity;
    pen.fillStyle = colour(name);
    for (const [x, y] of points) {
      pen.beginPath();
      pen.arc(this.x(x), this.y(y), radius, 0, 7);
      pen.fill();
    }
    pen.globalAlpha = 1;
    return this;
  }

  text(x, y, words, name = "ink", align = "center") {
    const { pen } = this;
    pen.font = "13px system-ui, sans-serif";
    pen.fillStyle = colour(name);
    pen.textAlign = align;
    pen.textBaseline = "middle";
    pen.fillText(words, this.x(x), this.y(y));
    return this;
  }

  // Writes above the plot what its lines are; entries: [words, name of the colour].
  legend(entries) {
    const { pen, box: [left, top] } = this;
    pen.font = "13px system-ui, sans-serif";
    pen.textAlign = "left";
    pen.textBaseline = "middle";
    let x = left;
    for (const [words, name] of entries) {
      pen.fillStyle = colour(name);
      pen.fillText(words, x, top - 10);
      x += pen.measureText(words).width + 14;
    }
    return this;
  }
}

// Writes words beside x, readable over lines.
function label(pen, words, x, y, name, align = "right") {
  pen.font = "12px system-ui, sans-serif";
  pen.textAlign = align;
  pen.textBaseline = "middle";
  pen.lineWidth = 4;
  pen.strokeStyle = colour("paper");
  pen.strokeText(words, x, y);
  pen.fillStyle = colour(name);
  pen.fillText(words, x, y);
}

// Draws a round handle that can be dragged.
function handle(pen, x, y, name = "orange", radius = 8) {
  pen.globalAlpha = 1;
  pen.fillStyle = colour(name);
  pen.strokeStyle = colour("paper");
  pen.lineWidth = 2;
  pen.beginPath();
  pen.arc(x, y, radius, 0, 7);
  pen.fill();
  pen.stroke();
}

// Draws an arrow.
function arrow(pen, x0, y0, x1, y1, name, width = 1.5) {
  const [angle, size] = [Math.atan2(y1 - y0, x1 - x0), Math.min(3 + 2 * width, Math.hypot(x1 - x0, y1 - y0))];
  pen.strokeStyle = pen.fillStyle = colour(name);
  pen.lineWidth = width;
  pen.beginPath();
  pen.moveTo(x0, y0);
  pen.lineTo(x1 - 0.6 * size * Math.cos(angle), y1 - 0.6 * size * Math.sin(angle));
  pen.stroke();
  pen.beginPath();
  pen.moveTo(x1, y1);
  for (const way of [-1, 1]) pen.lineTo(x1 - size * Math.cos(angle + 0.45 * way), y1 - size * Math.sin(angle + 0.45 * way));
  pen.fill();
}
