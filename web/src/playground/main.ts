import { Playground } from "./playground.ts";

const root = document.getElementById("playground");
if (root) {
  new Playground(root);
}
