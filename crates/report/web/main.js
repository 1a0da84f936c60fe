// Begins.

nameSensor();
filterRows();
const trusted = data.frequency_hz.map((_, row) => row).filter(isTrusted);
setCursor(trusted[Math.floor(trusted.length / 2)] ?? Math.floor(data.frequency_hz.length / 2));
drawAll();
openTarget();
