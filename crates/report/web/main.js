// Begins.

nameSensor();
filterRows();
const trusted = data.frequency_hz.map((_, row) => row).filter((row) => statusOf(row).name === "ok");
setCursor(trusted[Math.floor(trusted.length / 2)] ?? Math.floor(data.frequency_hz.length / 2));
drawAll();
