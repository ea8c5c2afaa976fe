// The language of the filter: comparisons over columns, phrases for them, words.
"use strict";

const PHRASES = [
  [/\bloss(?:es)? over ([\d.]+) ?s(?:econds)?\b/gi, "losses_s > $1"],
  [/\bat night\b/gi, "light = night"],
  [/\bat dusk\b/gi, "light = dusk"],
  [/\bby day\b/gi, "light = day"],
  [/\bfacing the sun\b/gi, "sun_facing > 0.5"],
  [/\bexperts\b/gi, "role = expert"],
  [/\btwins\b/gi, "role = twin"],
];
const COMPARISONS = {
  "<": (a, b) => a < b, "<=": (a, b) => a <= b, ">": (a, b) => a > b, ">=": (a, b) => a >= b, "=": (a, b) => a === b, "!=": (a, b) => a !== b,
};

// A function of the number of a flight; throws an Error in words where the text is no filter.
function filterOf(text, index) {
  const columns = new Map(index.columns.map(column => [column.name, column]));
  const plain = PHRASES.reduce((all, [phrase, meaning]) => all.replace(phrase, meaning), text);
  const tokens = plain.match(/"[^"]*"|<=|>=|!=|[<>=:()]|[^\s<>=:()!"]+|[!"]/g) || [];
  let at = 0;
  const next = () => tokens[at];
  const isOperator = token => token !== undefined && (Object.hasOwn(COMPARISONS, token) || token === ":");

  function either() {
    const parts = [all()];
    while (next() === "or") { at += 1; parts.push(all()); }
    return flight => parts.some(part => part(flight));
  }
  function all() {
    const parts = [];
    while (next() !== undefined && next() !== "or" && next() !== ")") {
      if (next() === "and") { at += 1; continue; }
      parts.push(one());
    }
    return flight => parts.every(part => part(flight));
  }
  function one() {
    const token = tokens[at];
    at += 1;
    if (token === "not") {
      if (next() === undefined) throw new Error("`not` needs something behind it");
      const part = one();
      return flight => !part(flight);
    }
    if (token === "(") {
      const part = either();
      if (next() !== ")") throw new Error("a bracket is not closed");
      at += 1;
      return part;
    }
    if (isOperator(token) || token === ")") throw new Error(`\`${token}\` needs a column before it`);
    return isOperator(next()) ? comparison(token) : word(unquoted(token));
  }
  function comparison(name) {
    const operator = tokens[at];
    const value = tokens[at + 1];
    at += 2;
    const column = columns.get(name);
    if (!column) throw new Error(`there is no column \`${name}\`; columns are ${[...columns.keys()].join(", ")}`);
    if (value === undefined || isOperator(value)) throw new Error(`\`${name} ${operator}\` needs a value behind it`);
    if (column.numbers) {
      const number = Number(value);
      if (operator === ":" || !Number.isFinite(number)) throw new Error(`\`${name}\` is compared with a number`);
      return flight => column.numbers[flight] !== null && COMPARISONS[operator](column.numbers[flight], number);
    }
    const wanted = unquoted(value).toLowerCase();
    if (operator === ":") return flight => column.texts[flight].toLowerCase().includes(wanted);
    if (operator !== "=" && operator !== "!=") throw new Error(`\`${name}\` is a text: compare it with = != or :`);
    return flight => COMPARISONS[operator](column.texts[flight].toLowerCase(), wanted);
  }
  function word(text) {
    const wanted = text.toLowerCase();
    const texts = index.columns.filter(column => column.texts);
    return flight => texts.some(column => column.texts[flight].toLowerCase().includes(wanted));
  }
  const unquoted = token => token.replace(/^"|"$/g, "");

  const found = either();
  if (at < tokens.length) throw new Error("a bracket is closed that was not opened");
  return found;
}
