// Puts a link below every listing of a policy, where the playground is beside the book. The link opens the listing in it.
(async () => {
  const playground = new URL(`${path_to_root}playground/index.html`, document.baseURI);
  const isThere = await fetch(playground, { method: "HEAD" }).then(({ ok }) => ok, () => false);
  if (!isThere) {
    return;
  }
  for (const code of document.querySelectorAll("pre > code.language-fsm")) {
    const listing = code.textContent.trim();
    // What is no machine by itself is some of a machine's items.
    const isMachine = /^machine\s/m.test(listing);
    const whisker = /^whisker\s/m.test(listing) ? "" : "whisker r0\n\n";
    const policy = isMachine ? listing : `machine example\n\n${whisker}${listing}\n\ninitial Still\n\nstate Still { stop }`;
    const link = document.createElement("a");
    link.href = `${playground}#policy=${encodeURIComponent(`${policy}\n`)}`;
    link.textContent = "try it";
    link.className = "try-it";
    code.parentElement.after(link);
  }
})();
