// The Face Mesh of npm's @mediapipe/face_mesh, which has its model with it: 478 points.

const kLooks = 4;  // at a face that is new

// The package says what is wrong in a box that nobody sees.
let problem = null;
window.alert = (text) => { problem = text; };

async function load(url) {
  await new Promise((resolve, reject) => {
    const script = document.createElement('script');
    Object.assign(script,
        {src: url, onload: resolve, onerror: () => reject(new Error('cannot load ' + url))});
    document.head.append(script);
  });
}

/**
 * A function that finds {points} of a picture (ImageData), shares of its width and height, or
 * {points: null}.
 */
export async function open(settings) {
  await load('/package/face_mesh.js');
  const mesh = new window.FaceMesh({locateFile: (file) => '/package/' + file});
  mesh.setOptions({
    maxNumFaces: 1,
    refineLandmarks: true,
    // minDetectionConfidence ends this version of the package
    minTrackingConfidence: settings.confidence,
    // of other names than those of index.d.ts: WebGL by the processor is slow
    useCpuInference: true,
  });
  let found = null;
  mesh.onResults((results) => {
    const face = results.multiFaceLandmarks?.[0];
    found = face ? Array.from(face, ({x, y, z}) => ({x, y, z})) : null;
  });
  const canvas = document.createElement('canvas');
  return async (picture) => {
    Object.assign(canvas, {width: picture.width, height: picture.height});
    canvas.getContext('2d', {willReadFrequently: true}).putImageData(picture, 0, 0);
    // A face is cut out where the last look found it. A new one is looked at until that is where it
    // is.
    for (let looks = found ? 1 : kLooks; looks > 0; --looks) {
      found = null;
      await mesh.send({image: canvas});
      if (problem) throw new Error(problem);
      if (!found) break;
    }
    return {points: found};
  };
}
