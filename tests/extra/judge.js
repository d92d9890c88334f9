// judge.js - the view and the light of judge.sh, and what its pages print of a picture.
const WIDTH = 198, HEIGHT = 132, FINE = 4; // pixels; those that are drawn along one side of them
const VIEW = {distance: 14, fov: 0.4, light: [1, 1, 2]};

// Prints the mean of FINE x FINE pixels each, row after row from the top, as three floats. pixels: RGBA from the bottom.
function print(name, pixels) {
    for (let y = 0; y < HEIGHT; y++) {
        const row = new Float32Array(3 * WIDTH);
        for (let x = 0; x < WIDTH * FINE; x++)
            for (let k = 0; k < FINE; k++) {
                const from = 4 * (((HEIGHT - 1 - y) * FINE + k) * WIDTH * FINE + x), to = 3 * Math.floor(x / FINE);
                for (let c = 0; c < 3; c++) row[to + c] += pixels[from + c] / (FINE * FINE);
            }
        console.log(`ROW ${name} ${y} ${btoa(String.fromCharCode(...new Uint8Array(row.buffer)))}`);
    }
}
