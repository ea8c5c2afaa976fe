// The list of flights: only what is in sight is drawn, whatever their number.
"use strict";

const ROW = 52;

class FlightList {
  constructor(index, choose) {
    this.index = index;
    this.choose = choose;
    this.order = index.worst;
    this.chosen = null;
    this.box = document.getElementById("list");
    this.rows = document.getElementById("rows");
    this.columns = new Map(index.columns.map(column => [column.name, column]));
    this.box.addEventListener("scroll", () => this.draw());
    this.rows.addEventListener("click", event => {
      const row = event.target.closest(".row");
      if (row) this.choose(Number(row.dataset.number));
    });
    new ResizeObserver(() => this.draw()).observe(this.box);
  }

  value(name, flight) {
    const column = this.columns.get(name);
    return column ? (column.texts || column.numbers)[flight] : undefined;
  }

  // Shows the flights that a filter lets through; by a column, the largest first, or the worst first.
  show(lets, sort) {
    const order = this.index.worst.filter(lets);
    const column = this.columns.get(sort);
    if (column && column.numbers) order.sort((a, b) => (column.numbers[b] ?? -Infinity) - (column.numbers[a] ?? -Infinity));
    if (column && column.texts) order.sort((a, b) => column.texts[a].localeCompare(column.texts[b]));
    this.order = order;
    this.rows.style.height = `${order.length * ROW}px`;
    this.draw();
  }

  // The flight some places behind the chosen one.
  step(places) {
    const at = this.order.indexOf(this.chosen);
    const flight = this.order[Math.max(0, Math.min(this.order.length - 1, at + places))];
    if (flight !== undefined) this.choose(flight);
  }

  mark(flight) {
    this.chosen = flight;
    const top = this.order.indexOf(flight) * ROW;
    if (top >= 0 && (top < this.box.scrollTop || top + ROW > this.box.scrollTop + this.box.clientHeight)) {
      this.box.scrollTop = top - this.box.clientHeight / 3;
    }
    this.draw();
  }

  draw() {
    const first = Math.max(0, Math.floor(this.box.scrollTop / ROW) - 3);
    const last = Math.min(this.order.length, Math.ceil((this.box.scrollTop + this.box.clientHeight) / ROW) + 3);
    this.rows.replaceChildren(...this.order.slice(first, last).map((flight, at) => this.row(flight, first + at)));
  }

  row(flight, at) {
    const row = document.createElement("div");
    row.className = "row";
    row.id = `row-${flight}`;
    row.dataset.number = flight;
    row.style.top = `${at * ROW}px`;
    row.setAttribute("role", "option");
    row.setAttribute("aria-selected", String(flight === this.chosen));
    row.setAttribute("aria-posinset", String(at + 1));
    row.setAttribute("aria-setsize", String(this.order.length));
    if (flight === this.chosen) this.box.setAttribute("aria-activedescendant", row.id);
    const name = document.createElement("b");
    const policy = this.value("policy", flight);
    name.textContent = this.value("name", flight) + (policy ? `, ${policy}` : "");
    const words = document.createElement("span");
    const facts = ["light", "town", "split"].map(column => this.value(column, flight)).filter(Boolean);
    words.textContent = [this.value("reason", flight), ...facts].join(" · ");
    row.title = `${name.textContent}: ${words.textContent}`;
    row.append(name, words);
    return row;
  }
}
