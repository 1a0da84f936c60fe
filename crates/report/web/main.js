// Begins.

nameSensor();
filterRows();
setCursor(Math.floor(data.frequency_hz.length / 2));
drawAll();
