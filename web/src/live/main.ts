import { Page } from "./page.ts";

const root = document.getElementById("live");
if (root) {
  new Page(root);
}
