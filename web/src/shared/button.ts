/** A button with a text and an action. Its name begins with the text, which people say to a computer that listens, unless that is a sign. */
export function button(label: string, action: (button: HTMLButtonElement) => void, description?: string): HTMLButtonElement {
  const button = document.createElement("button");
  button.type = "button";
  button.textContent = label;
  if (description !== undefined) {
    button.title = description;
    button.setAttribute("aria-label", description.startsWith(label) || !/[\p{L}\p{N}]/u.test(label) ? description : `${label}: ${description}`);
  }
  button.addEventListener("click", () => action(button));
  return button;
}
