// Feature points over the picture; their names under the pointer.

const NEAR = 14;  // CSS pixels

export class PointOverlay {
  constructor(canvas, tip, view) {
    Object.assign(this, {canvas, tip, view});
    this.shown = false;
    this.places = [];
    const {parentElement} = canvas;
    parentElement.addEventListener('pointermove', (event) => this.hover(event));
    parentElement.addEventListener('pointerdown', (event) => this.hover(event));
    parentElement.addEventListener('pointerleave', () => { this.tip.hidden = true; });
  }

  set(shown) {
    this.shown = shown;
    this.tip.hidden = true;
    this.draw();
  }

  draw() {
    const {canvas, view} = this;
    const scale = Math.min(window.devicePixelRatio || 1, 2);
    canvas.hidden = !this.shown;
    if (!this.shown) return;
    canvas.width = Math.max(1, Math.round(canvas.clientWidth * scale));
    canvas.height = Math.max(1, Math.round(canvas.clientHeight * scale));
    const pen = canvas.getContext('2d');
    pen.scale(scale, scale);
    this.places = view.points();
    for (const {x, y, facing, head} of this.places) {
      pen.globalAlpha = facing > 0 ? 1 : 0.25;
      pen.beginPath();
      pen.arc(x, y, 3, 0, 2 * Math.PI);
      pen.fillStyle = head === 1 ? '#ffb347' : '#3ad0ff';
      pen.fill();
      pen.strokeStyle = '#0b1a24';
      pen.stroke();
    }
  }

  hover(event) {
    if (!this.shown) return;
    const box = this.canvas.getBoundingClientRect();
    const [x, y] = [event.clientX - box.left, event.clientY - box.top];
    const distance = (place) => Math.hypot(place.x - x, place.y - y);
    const near = this.places.filter((place) => distance(place) < NEAR)
        .sort((a, b) => (b.facing > 0) - (a.facing > 0) || distance(a) - distance(b))[0];
    this.tip.hidden = !near;
    if (!near) return;
    this.tip.textContent = `${near.id} ${near.name}`;
    this.tip.style.left = `${Math.min(near.x + 10, box.width - this.tip.offsetWidth - 4)}px`;
    this.tip.style.top = `${Math.max(near.y - 30, 4)}px`;
  }
}
