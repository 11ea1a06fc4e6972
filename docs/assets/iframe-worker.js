// Browsers start no Worker from a file. Where pages are read from disk, the search's script runs in a hidden frame instead.
if (location.protocol === "file:") {
  window.Worker = class {
    constructor(address) {
      this.frame = document.createElement("iframe");
      this.frame.hidden = true;
      document.documentElement.append(this.frame);
      const inside = this.frame.contentWindow;
      inside.postMessage = (message) => this.#later(() => this.onmessage, message);
      const script = inside.document.createElement("script");
      this.ready = new Promise((resolve) => (script.onload = resolve));
      script.onerror = (event) => this.onerror?.(event);
      script.src = address;
      inside.document.body.append(script);
    }
    async postMessage(message) {
      await this.ready;
      this.#later(() => this.frame.contentWindow?.onmessage, message);
    }
    terminate() {
      this.frame.remove();
    }
    // A copy, and not before what runs now has ended: as between a page and a Worker.
    #later(listener, message) {
      const data = structuredClone(message);
      setTimeout(() => listener()?.({ data }));
    }
  };
}
