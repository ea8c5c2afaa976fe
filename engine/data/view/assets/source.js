// Where data come from: the server, or the page itself where it was exported.
"use strict";

const source = (() => {
  const inside = document.getElementById("data");
  const held = inside ? JSON.parse(inside.textContent) : null;
  let version = "";

  async function get(path) {
    if (held) {
      if (path in held) return held[path];
      throw new Error("this flight is not in the exported page");
    }
    let answer;
    try {
      answer = await fetch(path);
    } catch {
      throw new Error("the server has ended; start `cosfly view` again");
    }
    if ((answer.headers.get("content-type") || "").startsWith("application/json")) {
      const value = await answer.json();
      if (answer.ok) return value;
      throw new Error([value.message, ...(value.causes || []), ...(value.hints || [])].join("\n"));
    }
    throw new Error(await answer.text());
  }

  // Towns of an exported page are held by their names.
  function town(number, name) {
    return get(held && `town ${name}` in held ? `town ${name}` : `/api/town/${number}`);
  }

  // Address of a picture; of an exported page that of the last one before.
  function picture(number, frame, channel) {
    if (!held) return `/picture/${number}/${frame}/${channel}?v=${version}`;
    for (let at = frame; at >= 0; at -= 1) {
      const address = held[`/picture/${number}/${at}/${channel}`];
      if (address) return address;
    }
    return null;
  }

  return {
    get, town, picture,
    isExported: held !== null,
    has: number => !held || held.held.includes(number),
    setVersion: text => { version = encodeURIComponent(text); },
  };
})();
