// Filters of the ledger, and links into closed records.
"use strict";
(() => {
  const claims = document.querySelectorAll("details.claim");
  for (const button of document.querySelectorAll("[data-verdict]")) {
    button.addEventListener("click", () => {
      for (const other of document.querySelectorAll("[data-verdict]")) {
        other.setAttribute("aria-pressed", String(other === button));
      }
      const wanted = button.dataset.verdict;
      for (const claim of claims) claim.hidden = wanted !== "all" && !claim.classList.contains(wanted);
    });
  }
  const open = () => {
    const target = location.hash && document.getElementById(location.hash.slice(1));
    if (target instanceof HTMLDetailsElement) { target.hidden = false; target.open = true; target.scrollIntoView(); }
  };
  window.addEventListener("hashchange", open);
  open();
})();
