// A schematic face from FAP values. Numbers are those of the standard; left is the person's left.
const Face = (() => {
  // Distances of the neutral face on a ground of 320 x 360, and the units that follow from them.
  const eyes = 92, nose = 66, mouthNose = 34, mouthWidth = 78, iris = 20;
  const unit = {ES: eyes / 1024, ENS: nose / 1024, MNS: mouthNose / 1024, MW: mouthWidth / 1024,
                IRISD: iris / 1024};
  const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

  // Value of the first of these FAPs that is there.
  const pick = (values, ...numbers) => {
    for (const number of numbers) if (values[number] !== undefined) return values[number];
    return 0;
  };

  // Opening of the inner lips in units of the mouth-nose separation.
  function opening(values) {
    const lips = values[4] !== undefined || values[5] !== undefined;
    const steps = lips ? -pick(values, 4) - pick(values, 5) : pick(values, 3);
    return Math.max(0, steps / 1024);
  }

  function lips(values, outer) {
    const has = (number) => values[number] !== undefined;
    const o = (outerNumber, innerNumber) =>
        outer ? pick(values, outerNumber, innerNumber) : pick(values, innerNumber, outerNumber);
    const jaw = pick(values, 3), follow = has(5) || has(52) ? 0 : -jaw;
    return {
      left: o(53, 6) * unit.MW, right: o(54, 7) * unit.MW,
      leftUp: o(59, 12) * unit.MNS, rightUp: o(60, 13) * unit.MNS,
      top: o(51, 4) * unit.MNS, bottom: (o(52, 5) + follow) * unit.MNS,
      topSides: (o(55, 8) + o(56, 9)) / 2 * unit.MNS,
      bottomSides: ((o(57, 10) + o(58, 11)) / 2 + (has(10) || has(57) ? 0 : follow)) * unit.MNS,
    };
  }

  function lipPath(draw, at, lip, width, rise, fall) {
    const left = at.x + width + lip.left, right = at.x - width - lip.right;
    const leftY = at.y - lip.leftUp, rightY = at.y - lip.rightUp;
    const top = at.y - rise + (lip.top + lip.topSides) / 2;
    const bottom = at.y + fall - (lip.bottom + lip.bottomSides) / 2;
    draw.beginPath();
    draw.moveTo(right, rightY);
    draw.bezierCurveTo(right + width * 0.5, 2 * top - at.y, left - width * 0.5, 2 * top - at.y,
        left, leftY);
    draw.bezierCurveTo(left - width * 0.5, 2 * bottom - at.y, right + width * 0.5,
        2 * bottom - at.y, right, rightY);
    draw.closePath();
  }

  function drawEye(draw, x, y, values, top, bottom, yaw, pitch) {
    const height = 13;
    const upper = Math.min(height, -height + pick(values, top) * unit.IRISD);
    const lower = Math.max(upper, height * 0.75 - pick(values, bottom) * unit.IRISD);
    draw.save();
    draw.beginPath();
    draw.moveTo(x - 24, y);
    draw.quadraticCurveTo(x, y + 1.7 * upper, x + 24, y);
    draw.quadraticCurveTo(x, y + 1.7 * lower, x - 24, y);
    draw.fillStyle = '#fdfdfd';
    draw.fill();
    draw.clip();
    draw.beginPath();
    const gaze = 1e-5 * 22;
    draw.arc(x + pick(values, yaw) * gaze, y + pick(values, pitch) * gaze, iris / 2, 0, 7);
    draw.fillStyle = '#3a2c25';
    draw.fill();
    draw.restore();
    draw.beginPath();
    draw.moveTo(x - 24, y);
    draw.quadraticCurveTo(x, y + 1.7 * upper, x + 24, y);
    draw.strokeStyle = colour('--hair');
    draw.lineWidth = 2.5;
    draw.stroke();
  }

  function drawBrow(draw, x, y, side, values, numbers) {
    const [inner, middle, outer] = numbers.map((number) => pick(values, number) * unit.ENS);
    draw.beginPath();
    draw.moveTo(x - side * 20, y - inner);
    draw.quadraticCurveTo(x, y - 8 - 1.5 * middle, x + side * 26, y + 2 - outer);
    draw.strokeStyle = colour('--hair');
    draw.lineWidth = 6;
    draw.lineCap = 'round';
    draw.stroke();
  }

  function draw(canvas, values) {
    const scale = canvas.clientWidth / 320 * devicePixelRatio;
    const width = Math.round(320 * scale), height = Math.round(360 * scale);
    if (canvas.width !== width || canvas.height !== height) {
      canvas.width = width;
      canvas.height = height;
    }
    const context = canvas.getContext('2d');
    context.setTransform(scale, 0, 0, scale, 0, 0);
    context.clearRect(0, 0, 320, 360);
    const angle = 1e-5;
    context.translate(160, 300);
    context.rotate(-pick(values, 50) * angle);  // positive: to the right of the person
    context.translate(-160, -300);
    const turn = pick(values, 49) * angle * 60, nod = pick(values, 48) * angle * 60;
    const jaw = pick(values, 3) * unit.MNS;
    context.beginPath();  // head
    context.ellipse(160, 168, 122, 140, 0, Math.PI, 0);
    context.bezierCurveTo(282, 270 + jaw, 222, 332 + jaw, 160, 334 + jaw);
    context.bezierCurveTo(98, 332 + jaw, 38, 270 + jaw, 38, 168);
    context.fillStyle = colour('--skin');
    context.fill();
    context.translate(turn, nod);
    const y = 158, mouth = {x: 160, y: y + nose + mouthNose};
    drawEye(context, 160 + eyes / 2, y, values, 19, 21, 23, 25);
    drawEye(context, 160 - eyes / 2, y, values, 20, 22, 24, 26);
    drawBrow(context, 160 + eyes / 2, y - 32, 1, values, [31, 33, 35]);
    drawBrow(context, 160 - eyes / 2, y - 32, -1, values, [32, 34, 36]);
    context.beginPath();  // nose
    context.moveTo(160 - 15, y + nose - 6);
    context.quadraticCurveTo(160, y + nose + 8, 160 + 15, y + nose - 6);
    context.strokeStyle = colour('--shade');
    context.lineWidth = 3;
    context.stroke();
    lipPath(context, mouth, lips(values, true), mouthWidth / 2, 6, 8);
    context.fillStyle = colour('--lip');
    context.fill();
    lipPath(context, mouth, lips(values, false), mouthWidth / 2 - 6, 0.6, 0.6);
    context.fillStyle = colour('--mouth');
    context.fill();
  }
  return {draw, opening};
})();
