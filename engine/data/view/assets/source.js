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

  // The frame whose picture is shown: an exported page has few, and the last one before stands for a frame without one.
  function pictured(number, frame, channel) {
    for (let at = frame; held && at >= 0; at -= 1) {
      if (`/picture/${number}/${at}/${channel}` in held) return at;
    }
    return frame;
  }

  // Address of the picture of a frame; null where an exported page has none.
  function picture(number, frame, channel) {
    const path = `/picture/${number}/${frame}/${channel}`;
    return held ? held[path] ?? null : `${path}?v=${version}`;
  }

  return {
    get, town, pictured, picture,
    isExported: held !== null,
    has: number => !held || held.held.includes(number),
    setVersion: text => { version = encodeURIComponent(text); },
  };
})();
