// Pictures of the frame with boxes; neighbours of the frame are fetched ahead.
"use strict";

const KEPT = 240;
const AHEAD = 6;

class Pictures {
  constructor(box) {
    this.box = box;
    this.images = new Map();
    this.panes = [];
    // Set while a flight and the one beside it are being opened.
    this.isOpening = false;
  }

  // A pane for each channel of the flight, and one for the colours of the flight beside. Exported pages have colours alone.
  show(flight, beside) {
    const channels = (flight.channels || []).filter(channel => !source.isExported || channel === "rgb");
    const panes = channels.map(channel => ({ flight, channel, words: channel }));
    if (beside && (beside.channels || []).includes("rgb")) panes.splice(1, 0, { flight: beside, channel: "rgb", words: `${beside.name}, rgb` });
    this.panes = panes.map(pane => ({ ...pane, canvas: document.createElement("canvas"), caption: element("figcaption", pane.words) }));
    this.box.hidden = !panes.length;
    this.box.replaceChildren(...this.panes.map((pane, at) => {
      const figure = document.createElement("figure");
      figure.className = at === 0 && panes.length % 2 === 1 ? "wide" : "";
      [pane.canvas.width, pane.canvas.height] = pane.flight.size;
      pane.canvas.setAttribute("role", "img");
      pane.canvas.setAttribute("aria-label", `${pane.flight.name}: ${pane.channel}`);
      figure.append(pane.canvas, pane.caption);
      return figure;
    }));
  }

  draw(frame) {
    this.wanted = frame;
    for (const pane of this.panes) {
      const at = this.place(pane, frame);
      const image = this.image(pane, at);
      if (image && image.dataset.isBroken) this.blank(pane, frame);
      else if (image && image.complete && image.naturalWidth) this.paint(pane, image, at, frame);
    }
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.fetchAhead(frame), 30);
  }

  image(pane, frame) {
    const address = source.picture(pane.flight.number, frame, pane.channel);
    if (!address) return null;
    let image = this.images.get(address);
    if (image) {
      this.images.delete(address);
    } else {
      image = new Image();
      const isWanted = () => source.picture(pane.flight.number, this.place(pane, this.wanted), pane.channel) === address;
      image.onload = () => { if (isWanted()) this.draw(this.wanted); };
      image.onerror = () => { image.dataset.isBroken = "yes"; image.onload(); };
      image.src = address;
    }
    this.images.set(address, image);
    while (this.images.size > KEPT) this.images.delete(this.images.keys().next().value);
    return image;
  }

  // The frame that a pane shows: a flight beside may be shorter, and not every frame of an exported page has a picture.
  place(pane, frame) {
    return source.pictured(pane.flight.number, Math.min(frame, pane.flight.x.length - 1), pane.channel);
  }

  // Neighbours wait for the pictures of the frame: a browser loads few at a time. Each picture that comes draws again.
  fetchAhead(frame) {
    const isMissing = pane => { const image = this.image(pane, this.place(pane, frame)); return image && !image.complete; };
    if (this.isOpening || this.panes.some(isMissing)) return;
    for (const pane of this.panes) {
      for (let step = 1; step <= AHEAD; step += 1) {
        [frame + step, frame - step].filter(at => at >= 0 && at < pane.flight.x.length).forEach(at => this.image(pane, this.place(pane, at)));
      }
    }
  }

  // No picture is better than that of another frame.
  blank(pane, frame) {
    const context = pane.canvas.getContext("2d");
    context.clearRect(0, 0, pane.canvas.width, pane.canvas.height);
    context.fillStyle = "#fff";
    context.font = `${Math.ceil(pane.canvas.height / 12)}px sans-serif`;
    context.fillText("this picture cannot be read", pane.canvas.width / 20, pane.canvas.height / 2);
    pane.canvas.dataset.frame = frame;
  }

  paint(pane, image, at, frame) {
    const context = pane.canvas.getContext("2d");
    context.drawImage(image, 0, 0, pane.canvas.width, pane.canvas.height);
    const thickness = Math.max(1, pane.canvas.width / 400);
    const box = (edges, colour) => {
      if (!edges) return;
      context.strokeStyle = colour;
      context.lineWidth = thickness;
      context.strokeRect(edges[0], edges[1], edges[2] - edges[0], edges[3] - edges[1]);
    };
    if (pane.channel === "rgb") ((pane.flight.boxes || new Map()).get(at) || []).forEach(edges => box(edges, "#b57bff"));
    box(pane.flight.full_box && pane.flight.full_box[at], "#ffdc28");
    box(pane.flight.visible_box && pane.flight.visible_box[at], "#3cff5a");
    pane.caption.textContent = at === frame ? pane.words : `${pane.words}, frame ${at}`;
    pane.canvas.dataset.frame = frame;
  }
}
