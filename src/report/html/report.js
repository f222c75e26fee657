"use strict";
(function () {
  var find = function (id) { return document.getElementById(id); };
  var tools = find("tools"), text = find("text"), outcome = find("outcome"), code = find("code"), count = find("count");
  var programs = Array.prototype.slice.call(document.querySelectorAll("details.program"));
  var rows = {};
  document.querySelectorAll("tr[data-of]").forEach(function (row) { rows[row.dataset.of] = row; });
  var words = programs.map(function () { return null; });
  var at = -1;
  tools.hidden = false;

  // The text of a program is read when it is looked for first.
  function wordsOf(index) {
    if (words[index] === null) words[index] = programs[index].textContent.toLowerCase();
    return words[index];
  }
  function shows(program, index, wanted) {
    if (outcome.value && program.dataset.outcome !== outcome.value) return false;
    if (code.value && (" " + program.dataset.codes + " ").indexOf(" " + code.value + " ") < 0) return false;
    return !wanted || wordsOf(index).indexOf(wanted) >= 0;
  }
  function filter() {
    var wanted = text.value.trim().toLowerCase(), shown = 0;
    programs.forEach(function (program, index) {
      var is = shows(program, index, wanted);
      shown += is ? 1 : 0;
      program.hidden = !is;
      if (rows[program.id]) rows[program.id].hidden = !is;
    });
    count.textContent = shown + " of " + programs.length + " programs";
  }
  var waits = 0;
  function soon() { clearTimeout(waits); waits = setTimeout(filter, 120); }
  text.addEventListener("input", soon);
  outcome.addEventListener("change", filter);
  code.addEventListener("change", filter);
  function reset() { text.value = ""; outcome.value = ""; code.value = ""; filter(); }
  find("reset").addEventListener("click", reset);
  find("fold").addEventListener("click", function () {
    var open = programs.some(function (program) { return program.open; });
    programs.forEach(function (program) { program.open = !open; });
  });

  // A link into something that is folded or filtered away shows it.
  function follow() {
    var place = location.hash.length > 1 && find(decodeURIComponent(location.hash.slice(1)));
    if (!place) return;
    var program = place.closest("details");
    if (program && (program.hidden || !program.open)) {
      if (program.hidden) reset();
      program.open = true;
      place.scrollIntoView();
    }
    if (program) at = programs.indexOf(program);
  }
  window.addEventListener("hashchange", follow);
  follow();

  function step(by) {
    for (var next = at + by; next >= 0 && next < programs.length; next += by) {
      if (programs[next].hidden) continue;
      if (programs[at]) programs[at].classList.remove("here");
      at = next;
      programs[at].open = true;
      programs[at].classList.add("here");
      programs[at].scrollIntoView();
      programs[at].querySelector("summary").focus({ preventScroll: true });
      return;
    }
  }
  document.addEventListener("keydown", function (event) {
    var writes = /^(INPUT|SELECT|TEXTAREA)$/.test(event.target.tagName);
    if (event.key === "Escape" && event.target === text) { reset(); text.blur(); return; }
    if (writes || event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key === "/") { event.preventDefault(); text.focus(); text.select(); }
    if (event.key === "n") step(1);
    if (event.key === "p") step(-1);
    if (event.key === "q") { location.hash = "questions"; }
  });

  // What is ticked and written goes into the page itself, so that a saved page has it.
  document.addEventListener("input", function (event) {
    var field = event.target;
    if (tools.contains(field)) return;
    if (field.type === "checkbox") field.toggleAttribute("checked", field.checked);
    if (field.type === "text") field.setAttribute("value", field.value);
  });
  find("save").addEventListener("click", function () {
    reset();
    programs.forEach(function (program) { program.open = true; program.classList.remove("here"); });
    tools.hidden = true;
    var page = "<!doctype html>\n" + document.documentElement.outerHTML + "\n";
    tools.hidden = false;
    var link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([page], { type: "text/html" }));
    link.download = decodeURIComponent(location.pathname.split("/").pop()) || "report.html";
    link.click();
  });
  window.addEventListener("beforeprint", function () {
    programs.forEach(function (program) { program.open = true; });
  });
  filter();
})();
