/** A button with a text and an action. */
export function button(label: string, action: (button: HTMLButtonElement) => void, description?: string): HTMLButtonElement {
  const button = document.createElement("button");
  button.type = "button";
  button.textContent = label;
  if (description !== undefined) {
    button.title = description;
    button.setAttribute("aria-label", description);
  }
  button.addEventListener("click", () => action(button));
  return button;
}
